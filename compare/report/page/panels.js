// ---- panels.js: shows results and costs as sentences and tables.

const rendered = sides.every(side => side.rendering); // then times and skips are known
const tag = side => make("span", { class: side.style }, `${side.symbol} ${side.name}`);
const secondsOf = side => side.rendering.statistics.seconds;
const workSeconds = side => secondsOf(side).prepare + secondsOf(side).render;
const samplesText = side => `${countOf(side.rendering.statistics.samples_per_pixel, "sample")} per pixel`;

// Shows only the sections that have content.
function showSections() {
  const there = { hits: Boolean(data.hits), rendered };
  for (const section of document.querySelectorAll("[data-needs]")) section.hidden = !there[section.dataset.needs];
  if (!data.hits) element("figures").className = "single";
}

function showSummary() {
  element("title").textContent = data.title;
  const strong = (text, style = "") => make("strong", { class: style }, text), parts = [];
  if (rendered) {
    const [a, b] = sides.map(workSeconds), ratio = Math.max(a, b) / Math.min(a, b);
    const [prepareA, prepareB] = sides.map(side => secondsText(secondsOf(side).prepare));
    parts.push(
        strong(`${sides[0].symbol} ${sides[0].name}`, "side-a"), ": ", strong(secondsText(a)),
        ` for ${samplesText(sides[0])}. `, strong(`${sides[1].symbol} ${sides[1].name}`, "side-b"), ": ",
        strong(secondsText(b)), ` for ${samplesText(sides[1])}`,
        Number.isFinite(ratio) && ratio >= 1.05 ?
            (b > a ? `, ${ratioText(ratio)} times as long. ` : `, ${ratioText(ratio)} times as fast. `) :
            ". ",
        `Preparing the scene, once for all samples, took ${prepareA} and ${prepareB} of that. `);
  } else parts.push(`${width} × ${height} pixels. `);
  if (data.hits) {
    const hits = data.hits.figures;
    parts.push(
        "They see the same primitive in ", strong(percentText(hits.same / hits.pixels)), " of the pixels",
        ...(hits.unexplained === 0 ? [" and differ nowhere without a reason. "] : [
          "; ",
          strong(`${countText(hits.unexplained)} ${hits.unexplained === 1 ? "differs" : "differ"} without a reason. `)
        ]));
  }
  parts.push(
      "The relative squared error is ", strong(figure(data.metrics.relmse)), `, ${data.flip.name} `,
      strong(figure(data.metrics.flip)), ".");
  fill("lede", ...parts);
}

const symbolOf = kind => element(`symbol-${verdicts[kind].key}`).content.firstElementChild.cloneNode(true);

function showHits() {
  const h = data.hits.figures, share = n => percentText(n / h.pixels);
  fill(
      "hits-text",
      "One ray through the center of each pixel, both ways. Where the answers differ, a double-precision ray judges.");
  const line = (kind, name, text) => row(name, text, countText(h[verdicts[kind].key]), {
    below: share(h[verdicts[kind].key]), symbol: kind ? symbolOf(kind) : null, bad: kind === 3 && h.unexplained > 0 });
  fill(
      "hits-table",
      make(
          "tbody", {}, line(0, "Same", "the same object and primitive, or nothing in both"),
          line(1, "Edge", "a ray moved by at most 1/128 pixel sees the other one"),
          line(2, "Depth tie", "both surfaces lie at the same distance"),
          line(3, "Unexplained", "none of these: a fault in one of the pipelines"),
          row("Distance",
              "how far apart, along the surface normal, both place the hit of the same primitive, relative to its " +
                  `distance t from the eye: largest |Δt|·|cos θ| / t; bound ${figure(h.distance.bound)}`,
              figure(h.distance.worst), {
                below: h.distance.violations ? `${countText(h.distance.violations)} pixels over the bound` :
                                               "none over the bound",
                bad: h.distance.violations > 0
              })));
  if (h.unexplained_pixels.length) fill("unexplained", unexplainedTable(h.unexplained_pixels));
}

function unexplainedTable(pixels) {
  const cell = hit => make(
      "td", {}, hit.object === null ? "nothing" : `${data.hits.objects[hit.object]} : ${hit.primitive}`,
      make("small", {}, hit.object === null ? "" : `t = ${radianceText(hit.t)}`));
  const heads = ["Pixel", ...sides.map(side => `${side.symbol} ${side.name}`), "Double precision"];
  return make(
      "details", {open: ""}, make("summary", {}, "The unexplained pixels"),
      make(
          "div", {class: "wide"},
          make(
              "table", {}, make("thead", {}, make("tr", {}, ...heads.map(t => make("th", {scope: "col"}, t)))),
              make(
                  "tbody", {},
                  ...pixels.map(
                      p => make(
                          "tr", {}, make("td", {}, pixelLink(p.pixel, "hits")), cell(p.raster), cell(p.raytrace),
                          cell(p.exact)))))));
}

function track(pieces, total, style) {
  return make(
      "div", {class: `track ${style}`, "aria-hidden": "true"},
      ...pieces.filter(p => p.value > 0).map(p => make("div", {
                                               class: `piece ${p.kind || ""}`,
                                               style: `width:${(100 * p.value / total).toFixed(3)}%`,
                                               title: `${p.name}: ${secondsText(p.value)}`
                                             })));
}

function showTimes() {
  const longest = Math.max(...sides.map(workSeconds), 1e-9);
  fill(
      "time-text",
      "Both bars run on the same clock: preparing the scene (pale) and rendering it. Below, each pipeline's stages " +
      "against its own total.");
  const clock = make("div", { class: "bars" });
  for (const side of sides) {
    const { prepare, render } = secondsOf(side);
    clock.append(
        tag(side),
        track(
            [{name: "prepare", value: prepare, kind: "prepare"}, {name: "render", value: render}], longest, side.style),
        make("span", {class: "value"}, secondsText(workSeconds(side))));
  }
  fill("clock", clock);
  fill("stages", ...sides.map(side => {
    const stages = side.rendering.stages, prepare = secondsOf(side).prepare, rows = make("div", {class: "bars small"});
    const total = Math.max(workSeconds(side), ...stages.map(stage => stage[1]), 1e-9);
    for (const [name, value] of [["prepare", prepare], ...stages])
      rows.append(
          make("span", {class: "name"}, name),
          track([{name, value, kind: name === "prepare" ? "prepare" : ""}], total, side.style),
          make("span", {class: "value"}, secondsText(value)));
    return make("div", {}, make("h3", {}, tag(side)), rows);
  }));
}

function showSkipped() {
  const [a, b] = sides.map(side => side.rendering.statistics.approximations);
  fill("approximations-title", `What the ${sides[0].name.toLowerCase()} approximates`);
  fill("approximations", a.length ? make("ul", { class: "plain" }, ...a.map(text => make("li", {}, text)))
    : make("p", {}, `Nothing: in this scene it computes what the ${sides[1].name.toLowerCase()} computes.`));
  if (b.length)
    element("approximations").append(make("p", {}, `The ${sides[1].name.toLowerCase()}'s own: ${b.join("; ")}.`));
  fill("skipped", ...sides.map(side => {
    const entries = side.rendering.skipped;
    return make(
        "div", {}, make("h3", {}, tag(side)),
        entries.length ? make(
                             "table", {},
                             make(
                                 "tbody", {},
                                 ...entries.map(
                                     ([what, why, count]) => make(
                                         "tr", {}, make("th", {scope: "row"}, what),
                                         make(
                                             "td", {}, count < 0 ? why : countText(count),
                                             ...(count < 0 || !why ? [] : [make("small", {}, why)])))))) :
                         make("p", {}, "Nothing."));
  }));
}

function showFacts() {
  const facts = [
    ["Scene", r => r.scene], ["Size", r => `${r.width} × ${r.height}`],
    ["Samples per pixel", r => countText(r.samples_per_pixel)], ["Threads", r => r.threads],
    ["Primitives", r => countText(r.triangles)], ["Memory", r => `${(r.memory_bytes / 2 ** 20).toFixed(1)} MiB`],
    ["Rays", r => countText(r.rays.camera + r.rays.indirect + r.rays.shadow)], ["Seed", r => r.seed],
    ["Estimated relMSE", r => r.estimated_relmse === null ? "–" : figure(r.estimated_relmse)],
    ["Invalid samples", r => countText(r.invalid_samples)], ["Version", r => r.version]
  ];
  fill(
      "facts",
      make(
          "thead", {}, make("tr", {}, make("td", {}, ""), ...sides.map(side => make("th", {scope: "col"}, tag(side))))),
      make(
          "tbody", {},
          ...facts.map(
              ([name, get]) => make(
                  "tr", {}, make("th", {scope: "row"}, name),
                  ...sides.map(side => make("td", {}, String(get(side.rendering.statistics))))))));
}
