// ---- panels.js: the figures as sentences and tables.

const report = data.report;
const pipelines = [
  { key: "raster", name: "Rasterizer", symbol: "▲" },
  { key: "raytrace", name: "Path tracer", symbol: "●" },
];

// An element with attributes and children (strings become text: nothing from the data is ever read as HTML).
function make(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}
function fill(id, ...children) { element(id).replaceChildren(...children); }
const tag = p => make("span", { class: p.key }, `${p.symbol} ${p.name}`);

const workSeconds = p => report[p.key].seconds.prepare + report[p.key].seconds.render;
const ratioText = r => r >= 100 ? r.toFixed(0) : r >= 10 ? r.toFixed(0) : r.toFixed(1);
// Never rounded to all or nothing.
function percentText(share) {
  if (share === 0 || share === 1) return `${share * 100} %`;
  if (share < 0.0001) return "< 0.01 %";
  return share > 0.999 ? `${(Math.floor(share * 1e5) / 1e3).toFixed(3)} %` : `${(share * 100).toFixed(2)} %`;
}

function showLede() {
  const [raster, raytrace] = pipelines.map(workSeconds), hits = report.hits;
  const faster = raytrace >= raster;
  const ratio = faster ? raytrace / raster : raster / raytrace;
  element("title").textContent = data.title;
  fill("lede",
    "The ", make("strong", { class: "raster" }, "rasterizer"), " took ", make("strong", {}, secondsText(raster)),
    ", the ", make("strong", { class: "raytrace" }, "path tracer"), " ", make("strong", {}, secondsText(raytrace)),
    Number.isFinite(ratio) && ratio >= 1.05 ? `: ${ratioText(ratio)} times ${faster ? "as long" : "less"}. ` : ". ",
    "They see the same primitive in ", make("strong", {}, percentText(hits.same / hits.pixels)), " of the pixels",
    hits.unexplained === 0 ? " and differ nowhere without a reason. " : "; ",
    hits.unexplained === 0 ? "" : make("strong", {}, `${countText(hits.unexplained)} ${hits.unexplained === 1 ? "differs" : "differ"} without a reason. `),
    "The pictures' relative squared error is ", make("strong", {}, figure(report.metrics.relmse)), ".");
}

// A figure of a metric: three or four digits, small ones as a power of ten.
function figure(v) {
  if (v === null || v === undefined) return "none";
  const size = Math.abs(v);
  if (size !== 0 && size < 0.001) {
    const power = Math.floor(Math.log10(size));
    const digits = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };
    const factor = (v / 10 ** power).toFixed(2);
    return minus(`${factor === "1.00" ? "" : factor + "\u00a0·\u00a0"}10${[...String(power)].map(d => digits[d]).join("")}`);
  }
  return minus(size >= 100 ? v.toFixed(1) : size >= 10 ? v.toFixed(2) : size === 0 ? "0" : v.toFixed(size >= 1 ? 3 : 4));
}

function row(name, explanation, value, options = {}) {
  return make("tr", options.bad ? { class: "bad" } : {},
    make("th", { scope: "row" }, ...(options.symbol ? [options.symbol] : []), name, make("small", {}, explanation)),
    make("td", { class: "number" }, value, ...(options.below ? [make("small", {}, options.below)] : [])));
}

const symbolOf = kind => element(`symbol-${verdicts[kind].key}`).content.firstElementChild.cloneNode(true);

function showHits() {
  const h = report.hits, share = n => percentText(n / h.pixels);
  fill("hits-text", "One ray through the centre of each pixel, both ways. Where the answers differ, a double-precision ray judges.");
  const line = (kind, name, text) => row(name, text, countText(h[verdicts[kind].key]), {
    below: share(h[verdicts[kind].key]), symbol: kind ? symbolOf(kind) : null, bad: kind === 3 && h.unexplained > 0 });
  fill("hits-table", make("tbody", {},
    line(0, "Same", "the same object and primitive, or nothing in both"),
    line(1, "Edge", "a ray moved by at most 1/128 pixel sees the other one"),
    line(2, "Depth tie", "both surfaces lie at the same distance"),
    line(3, "Unexplained", "none of these: a fault in one of the pipelines"),
    row("Distance", `largest |Δt|·|cos θ| / t where both see the same; bound ${figure(h.distance.bound)}`,
      figure(h.distance.worst), { below: h.distance.violations ? `${countText(h.distance.violations)} pixels over the bound` : "none over the bound", bad: h.distance.violations > 0 })));
  if (!h.unexplained_pixels.length) return;
  const cell = hit => make("td", {}, hit.object === null ? "nothing" : `${hit.name} : ${hit.primitive}`, make("small", {}, hit.object === null ? "" : `t = ${radianceText(hit.t)}`));
  fill("unexplained", make("details", { open: "" }, make("summary", {}, "The unexplained pixels"), make("table", {},
    make("thead", {}, make("tr", {}, ...["Pixel", "▲ Rasterizer", "● Path tracer", "Double precision"].map(t => make("th", { scope: "col" }, t)))),
    make("tbody", {}, ...h.unexplained_pixels.map(p => {
      const link = make("a", { href: "#stage" }, `${p.pixel[0]}, ${p.pixel[1]}`);
      link.addEventListener("click", event => { event.preventDefault(); setMode("hits"); moveTo(p.pixel[0], p.pixel[1], 24); stage.scrollIntoView({ block: "center" }); });
      return make("tr", {}, make("td", {}, link), cell(p.raster), cell(p.raytrace), cell(p.exact));
    })))));
}

function showMetrics() {
  const m = report.metrics;
  const rows = [
    row("MSE", "mean squared difference", figure(m.mse)),
    row("RMSE", "its root", figure(m.rmse)),
    row("MAE", "mean absolute difference", figure(m.mae)),
    row("PSNR", "peak signal to noise; the peak is 1", m.psnr === null ? "∞" : `${m.psnr.toFixed(2)} dB`),
    row("relMSE", "mean of squared difference / (reference² + 0.01)", figure(m.relmse)),
    row("Mean signed error", "red, green, blue; positive: the rasterizer is brighter",
      make("span", { class: "triple" }, ...m.mean_signed_error.map(v => make("span", {}, v === null ? "none" : (v > 0 ? "+" : "") + figure(v))))),
  ];
  if (m.worst_pixel) {
    const link = make("a", { href: "#stage" }, `${m.worst_pixel[0]}, ${m.worst_pixel[1]}`);
    link.addEventListener("click", event => { event.preventDefault(); setMode("difference"); moveTo(m.worst_pixel[0], m.worst_pixel[1], 24); stage.scrollIntoView({ block: "center" }); });
    rows.push(row("Worst pixel", make("span", {}, "largest difference of a channel, at ", link), figure(m.worst)));
  }
  const bad = m.non_finite.raster + m.non_finite.raytrace;
  rows.push(row("Not finite", "pixels that are NaN or infinite and count nowhere", countText(bad), { bad: bad > 0 }));
  fill("metrics-table", make("tbody", {}, ...rows));
}

function bar(pieces, total, key) {
  return make("div", { class: `track ${key}`, "aria-hidden": "true" }, ...pieces.filter(p => p.value > 0).map(p =>
    make("div", { class: `piece ${p.kind || ""}`, style: `width:${(100 * p.value / total).toFixed(3)}%`, title: `${p.name}: ${secondsText(p.value)}` })));
}

function showTimes() {
  const longest = Math.max(...pipelines.map(workSeconds), 1e-9);
  fill("time-text", "Both bars run on the same clock: preparing the scene (pale) and rendering it. Below, each pipeline's stages against its own total.");
  const clock = make("div", { class: "bars" });
  for (const p of pipelines) {
    const s = report[p.key].seconds;
    clock.append(tag(p), bar([{ name: "prepare", value: s.prepare, kind: "prepare" }, { name: "render", value: s.render }], longest, p.key),
      make("span", { class: "value" }, secondsText(workSeconds(p))));
  }
  fill("clock", clock);
  fill("stages", ...pipelines.map(p => {
    const stages = data.stages[p.key];
    const total = Math.max(workSeconds(p), 1e-9), rows = make("div", { class: "bars small" });
    for (const [name, value] of [["prepare", report[p.key].seconds.prepare], ...stages])
      rows.append(make("span", { class: "name" }, name), bar([{ name, value, kind: name === "prepare" ? "prepare" : "" }], Math.max(total, ...stages.map(s => s[1])), p.key),
        make("span", { class: "value" }, secondsText(value)));
    return make("div", {}, make("h3", {}, tag(p)), rows);
  }));
}

function showSkipped() {
  const list = report.raster.approximations;
  fill("approximations", list.length ? make("ul", { class: "plain" }, ...list.map(text => make("li", {}, text)))
    : make("p", {}, "Nothing: in this scene it computes what the path tracer computes."));
  const ends = report.raytrace.approximations;
  if (ends.length) element("approximations").append(make("p", {}, "The path tracer's own: " + ends.join("; ") + "."));
  fill("skipped", ...pipelines.map(p => {
    const entries = data.skipped[p.key];
    return make("div", {}, make("h3", {}, tag(p)), entries.length ? make("table", {}, make("tbody", {}, ...entries.map(([what, why, count]) =>
      make("tr", {}, make("th", { scope: "row" }, what), make("td", {}, count < 0 ? why : countText(count), ...(count < 0 || !why ? [] : [make("small", {}, why)]))))))
      : make("p", {}, "Nothing."));
  }));
}

function showFacts() {
  const facts = [["Scene", r => r.scene], ["Size", r => `${r.width} × ${r.height}`], ["Samples a pixel", r => countText(r.samples_per_pixel)],
    ["Threads", r => r.threads], ["Primitives", r => countText(r.triangles)], ["Memory", r => `${(r.memory_bytes / 2 ** 20).toFixed(1)} MiB`],
    ["Rays", r => countText(r.rays.camera + r.rays.indirect + r.rays.shadow)], ["Seed", r => r.seed],
    ["Estimated relMSE", r => r.estimated_relmse === null ? "–" : figure(r.estimated_relmse)], ["Invalid samples", r => countText(r.invalid_samples)], ["Version", r => r.version]];
  fill("facts", make("thead", {}, make("tr", {}, make("th", {}, ""), ...pipelines.map(p => make("th", { scope: "col" }, tag(p))))),
    make("tbody", {}, ...facts.map(([name, get]) => make("tr", {}, make("th", { scope: "row" }, name), ...pipelines.map(p => make("td", {}, String(get(report[p.key]))))))));
}

// ---- the inspected pixel

const seen = hit => hit.object === 0 ? "nothing" : `${data.objects[hit.object - 1]} (object ${hit.object - 1}), primitive ${countText(hit.primitive)}`;

function showInspector(announce = false) {
  if (!decoded || state.px < 0) {
    fill("inspector", make("p", { class: "caption" }, "Point at a pixel, tap one, or focus the picture and use the arrow keys: its values and what each pipeline saw there appear here."));
    return;
  }
  const i = state.py * width + state.px, a = decoded.raster.rgb(i), b = decoded.raytrace.rgb(i), d = a.map((v, c) => v - b[c]);
  const luminance = v => 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2];
  const css = rgb => `rgb(${rgb.map(v => encodeSrgb(v * 2 ** state.ev)).join(" ")})`;
  const line = (name, color, values, format, sees) => {
    const cells = [...values, luminance(values)].map(v => make("td", { class: "number" }, format(v)));
    return [make("tr", {}, make("th", { scope: "row" }, make("span", { class: "swatch", style: `background:${color}` }), name), ...cells, make("td", { class: "sees" }, sees)),
      make("tr", { class: "sees-below" }, make("td", { colspan: 5 }, make("small", {}, sees)))];
  };
  const verdict = verdicts[decoded.verdict[i]].title;
  const hitA = seen(decoded.rasterHit(i)), hitB = seen(decoded.raytraceHit(i));
  fill("inspector", make("table", {},
    make("thead", {}, make("tr", {}, make("th", { scope: "col" }, `Pixel ${state.px}, ${state.py}`), ...["R", "G", "B", "Y"].map(t => make("th", { class: "number", scope: "col" }, t)), make("th", { class: "sees", scope: "col" }, ""))),
    make("tbody", {}, ...line(tag(pipelines[0]), css(a), a, radianceText, hitA), ...line(tag(pipelines[1]), css(b), b, radianceText, hitB),
      ...line("Difference", `rgb(${falseColor(state.palette, luminance(d) / state.range).join(" ")})`, d, signedText, `hits: ${verdict}`))));
  if (announce) element("announce").textContent = `Pixel ${state.px}, ${state.py}. Rasterizer ${a.map(radianceText).join(", ")}, sees ${hitA}. Path tracer ${b.map(radianceText).join(", ")}, sees ${hitB}. ${verdict}.`;
}
