// ---- tables.js: formats values and builds the tables.

const put = (tag, attributes, children = []) => make(tag, attributes, ...[].concat(children));
function duration(s) {
  if (s === null) return "–";
  return s < 0.0995 ? `${(s * 1e3).toPrecision(3)} ms` : `${s.toPrecision(3)} s`;
}
const percent = part => part === null ? "–" : `${(100 * part).toFixed(part < 0.0995 ? 1 : 0)} %`;
// Returns the upper half-width of the confidence band.
const bandOf = e => e.high === null || !e.value ? "" : `± ${percent(e.high / e.value - 1)}`;
const withBand = (e, text) => [text(e.value), " ", put("small", {}, bandOf(e))];

// Builds a table that the user can sort by each of its columns, a list of { name, cell(row) → node or text, key(row) →
// number or text to sort by, down: whether to sort downwards first }.
function sortableTable(rows, columns, caption) {
  const body = make("tbody");
  let sorted = -1, downwards = false;
  const heads = columns.map((column, i) => {
    const button = put("button", { type: "button" }, column.name);
    button.addEventListener("click", () => {
      downwards = sorted === i ? !downwards : Boolean(column.down);
      sorted = i;
      rows = [...rows].sort(
          (a, b) => (column.key(a) < column.key(b)     ? -1 :
                         column.key(a) > column.key(b) ? 1 :
                                                         0) *
              (downwards ? -1 : 1));
      heads.forEach(
          (head, k) => k === i ? head.setAttribute("aria-sort", downwards ? "descending" : "ascending") :
                                 head.removeAttribute("aria-sort"));
      fill();
    });
    return put("th", { scope: "col" }, button);
  });
  const fill = () => body.replaceChildren(
      ...rows.map(row => put("tr", {}, columns.map(column => put("td", column.attributes || {}, column.cell(row))))));
  fill();
  return put(
      "div", {class: "scroll"},
      put("table", {}, [put("caption", {}, caption), put("thead", {}, put("tr", {}, heads)), body]));
}

function efficiencyTable(rows, measure, indexOf) {
  // Efficiency is omitted for techniques that converge to something else, because they never reach a small error.
  const best = Math.max(...rows.filter(row => !row.note).map(row => measure.efficiency(row).value || 0));
  const meter = row => {
    if (row.note) return "–";
    const bar = put("i", { title: `${percent(measure.efficiency(row).value / best)} of the best` });
    bar.style.width = `${100 * (measure.efficiency(row).value || 0) / best}%`;
    bar.style.background = style(indexOf(row)).color;
    return bar;
  };
  return sortableTable(
      rows,
      [
        {
          name: "technique",
          cell: row =>
              [legendMark(indexOf(row)), rendererName(row),
               ...(row.counted ? [] : [put("small", {}, " (its other setting counts)")])],
          key: rendererName
        },
        {name: "samples", cell: row => String(row.spp), key: row => row.spp},
        {name: "seconds", cell: row => withBand(row.seconds, duration), key: row => row.seconds.value},
        {name: measure.name, cell: row => withBand(measure.error(row), figure), key: row => measure.error(row).value},
        {
          name: "dominates",
          cell: row =>
              row.dominates ? [row.dominates.at_most ? "< " : "", ...withBand(row.dominates.ratio, figure)] : "–",
          key: row => row.dominates ? row.dominates.ratio.value : 0,
          down: true
        },
        {
          name: `1 / (${measure.name} × s)`,
          cell: row => withBand(measure.efficiency(row), figure),
          key: row => measure.efficiency(row).value,
          down: true
        },
        {
          name: "of the best",
          cell: meter,
          key: row => measure.efficiency(row).value,
          down: true,
          attributes: {class: "meter"}
        },
        {
          name: "bias",
          cell: row => row.bias_share > 0 ? percent(row.bias_share) : "–",
          key: row => row.bias_share,
          down: true
        },
      ],
      `Efficiency is 1 / (${
          measure
              .name} × seconds): twice as much is half the error at the same time. ± is half the 95 % band; ` +
              `dominates the path tracer's time to the same relMSE over this row's; bias ` +
              `the part of the MSE that more samples would not take away.`);
}

function equalTimeTable(rows, rest) {
  const cell = e => e ? withBand(e, figure) : "–", key = e => e ? e.value : Infinity;
  const error = row => rest ? row.rest_mse : row.mse, ratio = row => rest ? row.rest_to_peer : row.to_peer;
  return sortableTable(
      rows,
      [
        {name: "at", cell: row => duration(row.seconds), key: row => row.seconds},
        {name: "technique", cell: row => row.name, key: row => row.name},
        {name: rest ? "MSE of the rest" : "MSE", cell: row => cell(error(row)), key: row => key(error(row))},
        {name: "over the peer's", cell: row => cell(ratio(row)), key: row => key(ratio(row))},
      ],
      "The error at equal time, between the measurements on either side; nothing is extrapolated. Over the peer's: " +
      "below 1 is less error.");
}

function baselineTable(baseline) {
  const verdict =
      row => [[row.slower, "slower", "bad"], [row.less_accurate, "less accurate", "bad"],
              [row.faster, "faster", "good"], [row.more_accurate, "more accurate", "good"]]
                 .filter(([is]) => is)
                 .map(([, text, kind]) => put("span", {class: kind}, (kind === "bad" ? "✗ " : "✓ ") + text + " "));
  return sortableTable(
      baseline.rows,
      [
        {name: "scene", cell: row => row.scene, key: row => row.scene},
        {name: "technique", cell: rendererName, key: rendererName},
        {name: "samples", cell: row => String(row.spp), key: row => row.spp},
        {
          name: "time, now / then",
          cell: row => withBand(row.seconds_ratio, figure),
          key: row => row.seconds_ratio.value,
          down: true
        },
        {
          name: "MSE, now / then",
          cell: row => withBand(row.mse_ratio, figure),
          key: row => row.mse_ratio.value,
          down: true
        },
        {
          name: "finding",
          cell: verdict,
          key: row =>
              (row.slower || row.less_accurate     ? 0 :
                   row.faster || row.more_accurate ? 1 :
                                                     2)
        },
      ],
      `Findings are significant at ${
          percent(baseline.significance)} for all rows together; times only where they changed by more than ${
          percent(baseline.drift)}, which a machine may do by itself.`);
}
