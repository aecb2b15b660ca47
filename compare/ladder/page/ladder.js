// ---- ladder.js: builds the tables, the images of the ladder, and the rungs.

const report = data.report;
const shareText = share => share === null ? "none" :
    Math.abs(share) < 5e-5                ? "0 %" :
                                            minus((100 * share).toFixed(2)) + " %";
const row = (...cells) => make("tr", {}, ...cells);
const head = (text, kind = {}) => make("th", { scope: "col", ...kind }, text);
const cell = (...content) => make("td", {}, ...content);
const figureCell = text => make("td", { class: "number" }, text);

function lede() {
  const spp = report.samples_per_pixel;
  const setting = `${report.width} × ${report.height} pixels, ${countOf(spp.raster, "sample")} per pixel rasterized, ${
      spp.raytrace} path-traced.`;
  if (report.nothing_to_explain)
    return [
      "The two images are ", make("strong", {}, "equal but for rounding"), ": there is nothing to explain. ", setting
    ];
  const [first, second] = report.shares.slice(0, -1).sort((a, b) => b.share - a.share),
                noise = report.shares.at(-1).share;
  const noisy = noise > 0.3 ?
      `Noise of the path tracer makes up ${shareText(noise)}: more samples (--spp) would tell more. ` :
      "";
  return [
    "The images differ by a relative mean squared error of ", make("strong", {}, radianceText(report.metrics.relmse)),
    ". The largest cause is ", make("strong", {}, first.title),
    ` (${shareText(first.share)} of the squared difference), then ` +
        `${second.title} (${shareText(second.share)}). ${noisy}${setting}`
  ];
}

// Draws a bar from zero to the share. All bars have the same scale.
function bar(share, color, low, high) {
  const at = v => 100 * (v - low) / (high - low);
  const left = at(Math.min(share, 0)), right = at(Math.max(share, 0));
  return make(
      "div", {class: "bar"},
      make("i", {style: `left:${left}%;width:${right - left}%;background:rgb(${color.join(",")})`}),
      make("b", {style: `left:${at(0)}%`}));
}

function sharesTable() {
  const values = report.shares.map(s => s.share ?? 0);
  const low = Math.min(0, ...values), high = Math.max(0.05, ...values);
  const body = report.shares.map(
      (s, i) =>
          row(make("th", {scope: "row"}, swatch(i), `${i < report.rungs.length ? i + 1 : "–"} ${s.title}`),
              cell(bar(s.share ?? 0, data.colors[i], low, high)), figureCell(shareText(s.share)),
              figureCell(shareText(s.largest_in))));
  fill(
      "shares",
      make(
          "thead", {},
          row(head("Cause"), head("Share of the squared difference", {colspan: 2}),
              head("Largest in, of the visible pixels", {class: "number"}))),
      make("tbody", {}, ...body),
      make(
          "tfoot", {},
          row(make("th", {scope: "row"}, "Sum, as computed"),
              make(
                  "td", {class: "number", colspan: 2},
                  report.shares_sum === null ? "none" : report.shares_sum.toFixed(12)),
              cell())));
}

// Shows the image at step k and the change by that step.
function showStep(k, buttons) {
  buttons.forEach((b, i) => b.setAttribute("aria-pressed", String(i === k)));
  const caption = k === 0       ? "the rasterizer's image" :
      k === report.rungs.length ? "all replaced: the path tracer's image" :
                                  `replaced so far: ${report.shares.slice(0, k).map(s => s.title).join("; ")}`;
  const figure = (url, name, text) =>
      make("figure", {}, make("img", {src: url, alt: text}), make("figcaption", {}, make("b", {}, name), " ", text));
  const share = report.shares[k - 1];
  fill("step", figure(data.pictures[k], `Image ${k}:`, caption), ...(k === 0 ? [] : [
         figure(
             data.changes[k - 1], `Image ${k - 1} − image ${k}:`, `${share.title}, share ${shareText(share.share)}`)
       ]));
}

function ladderSection() {
  const names = ["0 rasterized", ...report.rungs.map(r => `${r.rung} ${r.id}`)];
  const buttons = names.map(name => make("button", { type: "button" }, name));
  buttons.forEach((button, k) => button.addEventListener("click", () => showStep(k, buttons)));
  fill("steps", ...buttons);
  element("steps").addEventListener("keydown", event => {
    const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key], at = buttons.indexOf(document.activeElement);
    if (!way || at < 0) return;
    const next = clamp(at + way, 0, buttons.length - 1);
    buttons[next].focus();
    showStep(next, buttons);
  });
  fill("range", radianceText(data.range));
  const shares = report.shares.slice(0, -1).map(s => s.share ?? 0);
  showStep(shares.indexOf(Math.max(...shares)) + 1, buttons); // the step with the largest share
}

function figures(q) {
  const error = q.hits ?
      `${countText(q.hits.same)} of ${countText(q.hits.pixels)} pixels see the same primitive; ${
          countText(q.hits.edge)} differ at edges, ` +
          `${countText(q.hits.depth_tie)} by depth ties, ${countText(q.hits.unexplained)} without explanation` :
      q.metrics === null ?
      "no pixel is finite in both" :
      `RMSE ${figure(q.metrics.rmse)}, relMSE ${figure(q.metrics.relmse)}, ` +
          `mean signed error ${
              q.metrics.mean_signed_error.map(v => (v > 0 ? "+" : "") + figure(v)).join(", ")} (red, green, blue)`;
  const time = (side, how) => make(
      "span", {class: side},
      `${side === "raster" ? "▲" : "●"} ${secondsText(q.seconds[side])} ${how} (${
          countOf(q.samples_per_pixel[side], "sample")} per pixel)`);
  return make("p", {class: "figures"}, `${error} · `, time("raster", "rasterized"), " · ", time("raytrace", "traced"));
}

function rung(r, k) {
  const pictures = r.quantities.flatMap((q, i) => {
    const side = (key, mark, title) => make("figure", {},
      make("img", { loading: "lazy", src: data.rungs[k][i][key], alt: `${title}: ${q.name}` }),
      make("figcaption", {}, make("b", { class: key }, `${mark} ${title}`), ` (${q.name}). ${r.ways[key]}`));
    return [
      make("div", {class: "pair"}, side("raster", "▲", "Rasterizer"), side("raytrace", "●", "Path tracer")), figures(q)
    ];
  });
  return make(
      "article", {class: "rung"}, make("h3", {}, `${r.rung} ${r.title}`),
      ...(r.note ? [make("p", {class: "note"}, r.note)] : []), ...pictures);
}

function codeTable() {
  const sides = ["raster", "raytrace", "both"],
        all = [{rung: "–", title: "Frame: settings, loops, film", code: report.frame}, ...report.rungs];
  const files = side => cell(side.lines === 0 ? "0" : make("details", {}, make("summary", {}, countText(side.lines)),
    make("ul", {}, ...Object.entries(side.files).map(([file, lines]) => make("li", {}, `${file}: ${lines}`)))));
  const total = side => cell(countText(all.reduce((sum, r) => sum + r.code[side].lines, 0)));
  fill(
      "code",
      make("thead", {}, row(...["Rung", "▲ Rasterizer", "● Path tracer", "Shared by both"].map(text => head(text)))),
      make(
          "tbody", {},
          ...all.map(
              r => row(make("th", {scope: "row"}, `${r.rung} ${r.title}`), ...sides.map(side => files(r.code[side]))))),
      make("tfoot", {}, row(make("th", {scope: "row"}, "Together"), ...sides.map(total))));
}

startTheme();
fill("title", data.title);
fill("lede", ...lede());
fill(
    "cause-text",
    `Something is to be seen in ${
        shareText(report.visible_pixels)} of the pixels: there the 8-bit images differ by ` +
        `${data.visible_steps} steps or more; the other pixels are dark. The cause is that of a pixel and its ` +
        `neighbors together; gray: noise is larger than any.`);
sharesTable();
ladderSection();
element("rungs").append(...report.rungs.map(rung));
codeTable();
if (report.invalid_samples > 0)
  element("rungs").before(make(
      "p", {class: "note"},
      `${countOf(report.invalid_samples, "sample")} were NaN, infinite or negative, and were dropped.`));
showCauses();
