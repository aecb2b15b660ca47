// ---- plot.js: draws log-log plots in SVG. Curves differ in shape and dashes as well as in color. Each point can be
// reached by pointer and by keyboard and shows its values.

const svgNode = (name, attributes = {}, children = []) => {
  const node = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
};

// Each shape is a marker around the origin with a radius of 6.
const shapes = [
  "M-5.5-5.5h11v11h-11z", "M0-6a6 6 0 1 0 0.001 0z", "M0-7L6.5 5h-13z", "M0-7.5L7 0L0 7.5L-7 0z", "M0 7L6.5-5h-13z",
  "M-2-6h4v4h4v4h-4v4h-4v-4h-4v-4h4z", "M-6-3L0-7L6-3V4L0 7.5L-6 4z", "M-6-6L0-2.5L6-6L2.5 0L6 6L0 2.5L-6 6L-2.5 0z",
  "M0-7L2-2L7-2L3 1.5L4.5 7L0 3.5L-4.5 7L-3 1.5L-7-2L-2-2z",
];
const dashes = ["", "7 4", "2 4", "10 4 2 4"];
const style = index => ({
  color: `var(--s${index % 7})`,
  shape: shapes[index % shapes.length],
  dash: dashes[Math.floor(index / 7) % dashes.length]
});

const legendMark = index => {
  const { color, shape } = style(index);
  const mark = svgNode("svg", { class: "mark", viewBox: "-9 -9 18 18", "aria-hidden": "true" });
  mark.append(svgNode("path", { d: shape, fill: "var(--panel)", stroke: color, "stroke-width": 2 }));
  return mark;
};

const powerOfTen = e => e === 0 ? "1" : e === 1 ? "10" : powerText(e);

class LogAxis {
  constructor(low, high, from, to) {
    const pad = Math.max(0.06 * Math.log10(high / low), 0.08);
    this.low = Math.log10(low) - pad;
    this.high = Math.log10(high) + pad;
    this.from = from;
    this.to = to;
  }
  at(value) { return this.from + (Math.log10(value) - this.low) / (this.high - this.low) * (this.to - this.from); }
  // Ticks are powers of ten, with intermediate values if there are few.
  ticks() {
    const whole = [], fine = [];
    for (let e = Math.floor(this.low); e <= Math.ceil(this.high); ++e)
      for (let k = 1; k < 10; ++k) {
        const position = e + Math.log10(k);
        if (position < this.low || position > this.high) continue;
        (k === 1 ? whole : fine).push({ value: k * 10 ** e, label: k === 1 ? powerOfTen(e) : "" });
      }
    if (whole.length < 2) for (const tick of fine) tick.label = String(Number(tick.value.toPrecision(2)));
    return { whole, fine };
  }
}

const frame = { width: 640, height: 440, left: 66, right: 158, top: 12, bottom: 50 };

// Draws `curves`, a list of { name, index, points: [{ x, y, low, high, text }] }. `xTicks` may list the ticks of the x
// axis.
function plot({ curves, xName, yName, xTicks, label }) {
  const points = curves.flatMap(c => c.points);
  const xs = points.map(p => p.x), ys = points.flatMap(p => [p.y, p.low, p.high]).filter(v => v > 0);
  const svg = svgNode("svg", { viewBox: `0 0 ${frame.width} ${frame.height}`, role: "group", "aria-label": label });
  if (!points.length) return svg;
  const x = new LogAxis(Math.min(...xs), Math.max(...xs), frame.left, frame.width - frame.right);
  const y = new LogAxis(Math.min(...ys), Math.max(...ys), frame.height - frame.bottom, frame.top);
  drawGrid(svg, x, y, xTicks);
  drawGuides(svg, x, y);
  const groups = curves.map(curve => drawCurve(svg, curve, x, y));
  nameCurves(svg, curves, groups, x, y);
  svg.append(
      svgNode(
          "text", {x: (x.from + x.to) / 2, y: frame.height - 10, "text-anchor": "middle", class: "axis-name"}, [xName]),
      svgNode(
          "text",
          {transform: `translate(16 ${(y.from + y.to) / 2}) rotate(-90)`, "text-anchor": "middle", class: "axis-name"},
          [yName]));
  steerByKeys(groups.map(g => g.points));
  return svg;
}

function drawGrid(svg, x, y, xTicks) {
  const vertical = xTicks ? { whole: xTicks.map(v => ({ value: v, label: String(v) })), fine: [] } : x.ticks();
  const line = (fine, x1, y1, x2, y2) =>
      svg.append(svgNode("line", {class: fine ? "grid fine" : "grid", x1, y1, x2, y2}));
  for (const [list, fine] of [[vertical.fine, true], [vertical.whole, false]])
    for (const tick of list) {
      const at = x.at(tick.value);
      line(fine, at, y.from, at, y.to);
      if (tick.label) svg.append(svgNode("text", { x: at, y: y.from + 19, "text-anchor": "middle" }, [tick.label]));
    }
  const horizontal = y.ticks();
  for (const [list, fine] of [[horizontal.fine, true], [horizontal.whole, false]])
    for (const tick of list) {
      const at = y.at(tick.value);
      line(fine, x.from, at, x.to, at);
      if (tick.label) svg.append(svgNode("text", { x: x.from - 8, y: at + 4.5, "text-anchor": "end" }, [tick.label]));
    }
}

// Draws dotted lines of constant error × cost. Independent samples follow them.
function drawGuides(svg, x, y) {
  const clip = `plot-${document.querySelectorAll("clipPath").length}-${Math.random().toString(36).slice(2)}`;
  svg.append(svgNode(
      "clipPath", {id: clip}, [svgNode("rect", {x: x.from, y: y.to, width: x.to - x.from, height: y.from - y.to})]));
  const group = svgNode("g", { "clip-path": `url(#${clip})` });
  for (let c = Math.floor(x.low + y.low); c <= Math.ceil(x.high + y.high); ++c)
    group.append(svgNode("line", {
      class: "guide",
      x1: x.at(10 ** x.low),
      y1: y.at(10 ** (c - x.low)),
      x2: x.at(10 ** x.high),
      y2: y.at(10 ** (c - x.high))
    }));
  svg.append(group);
}

function drawCurve(svg, curve, x, y) {
  const { color, shape, dash } = style(curve.index);
  const group = svgNode("g", { class: "series" });
  const along = key =>
      curve.points.map(p => `${x.at(p.x).toFixed(1)} ${y.at(Math.max(p[key], 10 ** y.low)).toFixed(1)}`);
  group.append(
      svgNode(
          "path", {class: "band", fill: color, d: `M${along("high").join("L")}L${along("low").reverse().join("L")}z`}),
      svgNode("path", {class: "curve", stroke: color, "stroke-dasharray": dash, d: `M${along("y").join("L")}`}));
  const points = curve.points.map(p => {
    const px = x.at(p.x), py = y.at(p.y);
    group.append(svgNode(
        "line",
        {class: "bar", stroke: color, x1: px, x2: px, y1: y.at(Math.max(p.low, 10 ** y.low)), y2: y.at(p.high)}));
    const node = svgNode(
        "g", {
          class: "point",
          transform: `translate(${px} ${py})`,
          tabindex: -1,
          role: "img",
          "aria-label": p.text.replaceAll("\n", ", ")
        },
        [
          svgNode("circle", {class: "target", r: 13}), svgNode("circle", {class: "ring", r: 11}),
          svgNode("path", {class: "shape", d: shape, stroke: color})
        ]);
    node.addEventListener("pointerenter", () => showTip(node, p.text));
    node.addEventListener("pointerleave", hideTip);
    node.addEventListener("focus", () => showTip(node, p.text));
    node.addEventListener("blur", hideTip);
    return node;
  });
  group.append(...points);
  svg.append(group);
  return { group, points };
}

// Places each curve's name at its last point, moved apart where names would overlap. A name highlights its curve.
function nameCurves(svg, curves, groups, x, y) {
  const names = curves.map((curve, i) => ({curve, i, at: y.at(curve.points[curve.points.length - 1].y)}))
                    .sort((a, b) => a.at - b.at);
  const gap = 17;
  for (let k = 1; k < names.length; ++k) names[k].at = Math.max(names[k].at, names[k - 1].at + gap);
  const over = names.length ? names[names.length - 1].at - y.from : 0;
  if (over > 0)
    for (let k = names.length - 1; k >= 0; --k)
      names[k].at = Math.min(
          names[k].at - (k === names.length - 1 ? over : 0), k + 1 < names.length ? names[k + 1].at - gap : Infinity);
  for (const { curve, i, at } of names) {
    const last = curve.points[curve.points.length - 1];
    svg.append(svgNode("line", { class: "grid", x1: x.at(last.x) + 9, y1: y.at(last.y), x2: x.to + 8, y2: at }));
    const name = svgNode(
        "text", {class: "name", x: x.to + 11, y: at + 4.5, style: `fill: ${style(curve.index).color}`}, [curve.name]);
    name.addEventListener("pointerenter", () => groups.forEach((g, k) => g.group.classList.toggle("faded", k !== i)));
    name.addEventListener("pointerleave", () => groups.forEach(g => g.group.classList.remove("faded")));
    svg.append(name);
  }
}

// A plot is a single tab stop. The arrow keys move along a curve and between curves.
function steerByKeys(rows) {
  const all = rows.flat();
  if (all.length) all[0].setAttribute("tabindex", 0);
  rows.forEach((row, r) => row.forEach((node, i) => node.addEventListener("keydown", event => {
    const [dr, di] = {ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0]}[event.key] || [0, 0];
    if (event.key === "Escape") {
      hideTip();
      return;
    }
    if (!dr && !di) return;
    event.preventDefault();
    const next = rows[(r + dr + rows.length) % rows.length];
    const target = next[Math.min(Math.max(i + di, 0), next.length - 1)];
    for (const other of all) other.setAttribute("tabindex", -1);
    target.setAttribute("tabindex", 0);
    target.focus();
  })));
}

function showTip(node, text) {
  const tip = document.getElementById("tip"), box = node.getBoundingClientRect();
  tip.textContent = text;
  tip.hidden = false;
  const left = Math.min(
      Math.max(box.left + box.width / 2 - tip.offsetWidth / 2, 8),
      document.documentElement.clientWidth - tip.offsetWidth - 8);
  const above = box.top - tip.offsetHeight - 6;
  tip.style.left = `${left + scrollX}px`;
  tip.style.top = `${(above > 4 ? above : box.bottom + 6) + scrollY}px`;
}
function hideTip() { document.getElementById("tip").hidden = true; }
