// ---- viewer.js: the stage: drawing, and what hands do to it.

const element = id => document.getElementById(id);
const layers = { a: newCanvas(), b: newCanvas(), difference: newCanvas(), ground: newCanvas() };
let decoded = null, difference = null, disagreeing = [];
const verdicts = [
  { key: "same", title: "same" },
  { key: "edge", title: "edge", color: "#7db4ff", shape: "circle" },
  { key: "depth_tie", title: "depth tie", color: "#ffd166", shape: "square" },
  { key: "unexplained", title: "unexplained", color: "#ff4d88", shape: "cross" },
];
const shown = [false, true, true, true]; // which verdicts are marked

let frame = 0;
function redraw() {
  if (!frame) frame = requestAnimationFrame(() => { frame = 0; if (decoded) draw(); });
}

function draw() {
  const context = canvas.getContext("2d"), ratio = canvas.width / stageWidth;
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, stageWidth, stageHeight);
  const [first, second] = panes();
  if (state.mode === "split") {
    const at = state.split * stageWidth;
    drawLayer(context, layers.b, first, { x: at, y: 0, w: stageWidth - at, h: stageHeight }, decoded.raytrace);
    drawLayer(context, layers.a, first, { x: 0, y: 0, w: at, h: stageHeight }, decoded.raster);
  } else if (state.mode === "side") {
    drawLayer(context, layers.a, first, first, decoded.raster);
    drawLayer(context, layers.b, second, second, decoded.raytrace);
  } else if (state.mode === "flicker") {
    drawLayer(context, layers[state.show], first, first, state.show === "a" ? decoded.raster : decoded.raytrace);
  } else if (state.mode === "difference") {
    drawLayer(context, layers.difference, first, first, null);
  } else {
    drawLayer(context, layers.ground, first, first, null);
    drawMarks(context, first);
  }
  for (const pane of panes()) drawCursor(context, pane);
}

// One picture in a pane, cut to `window`; from a zoom of 10 with a grid, from 64 with each pixel's values.
function drawLayer(context, layer, pane, window, picture) {
  const z = zoomNow();
  context.save();
  context.beginPath();
  context.rect(window.x, window.y, window.w, window.h);
  context.clip();
  const [left, top] = toStage(pane, 0, 0);
  context.imageSmoothingEnabled = z < 2;
  context.imageSmoothingQuality = "high";
  context.drawImage(layer, left, top, width * z, height * z);
  if (z >= 10) drawGrid(context, pane, z);
  if (z >= 64) drawValues(context, pane, z, picture);
  context.restore();
}

function visiblePixels(pane) {
  const z = zoomNow();
  return {
    x0: Math.max(0, Math.floor(state.x - pane.w / z / 2)), x1: Math.min(width, Math.ceil(state.x + pane.w / z / 2)),
    y0: Math.max(0, Math.floor(state.y - pane.h / z / 2)), y1: Math.min(height, Math.ceil(state.y + pane.h / z / 2)) };
}

function drawGrid(context, pane, z) {
  const { x0, x1, y0, y1 } = visiblePixels(pane);
  context.strokeStyle = `rgb(128 128 128 / ${clamp((z - 6) / 30, 0.12, 0.5)})`;
  context.lineWidth = 1;
  context.beginPath();
  for (let x = x0; x <= x1; ++x) { const [sx] = toStage(pane, x, 0); context.moveTo(Math.round(sx) + 0.5, pane.y); context.lineTo(Math.round(sx) + 0.5, pane.y + pane.h); }
  for (let y = y0; y <= y1; ++y) { const [, sy] = toStage(pane, 0, y); context.moveTo(pane.x, Math.round(sy) + 0.5); context.lineTo(pane.x + pane.w, Math.round(sy) + 0.5); }
  context.stroke();
}

// Dark text on a light pixel, light on a dark one.
function drawValues(context, pane, z, picture) {
  const { x0, x1, y0, y1 } = visiblePixels(pane), size = clamp(z / 6.4, 10, 16);
  context.font = `${size}px ui-monospace, SFMono-Regular, Menlo, Consolas, monospace`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  for (let y = y0; y < y1; ++y) for (let x = x0; x < x1; ++x) {
    const i = y * width + x, [sx, sy] = toStage(pane, x + 0.5, y + 0.5);
    let lines, lightness;
    if (picture) {
      const rgb = picture.rgb(i);
      lines = rgb.map(radianceText);
      lightness = encodeSrgb((0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]) * 2 ** state.ev);
    } else if (state.mode === "difference") {
      const color = falseColor(state.palette, difference[i] / state.range);
      lines = [signedText(difference[i])];
      lightness = 0.3 * color[0] + 0.6 * color[1] + 0.1 * color[2];
    } else {
      const a = decoded.rasterHit(i), b = decoded.raytraceHit(i), name = h => h.object ? `${h.object - 1}:${h.primitive}` : "–";
      lines = decoded.verdict[i] ? [`▲ ${name(a)}`, `● ${name(b)}`] : [name(a)];
      lightness = 70;
    }
    context.fillStyle = lightness > 128 ? "#101214" : "#f4f5f6";
    lines.forEach((line, k) => context.fillText(line, sx, sy + (k - (lines.length - 1) / 2) * size * 1.3, z - 4));
  }
}

// A mark for every pixel whose hits differ: of one size on screen until pixels are larger than it.
function drawMarks(context, pane) {
  const z = zoomNow();
  for (const kind of [1, 2, 3]) {
    if (!shown[kind]) continue;
    const size = Math.max([0, 4, 8, 12][kind], z * 0.8);
    for (const i of disagreeing) {
      if (decoded.verdict[i] !== kind) continue;
      const [x, y] = toStage(pane, i % width + 0.5, Math.floor(i / width) + 0.5);
      if (x < -size || y < -size || x > stageWidth + size || y > stageHeight + size) continue;
      drawMark(context, kind, x, y, size);
    }
  }
}

function drawMark(context, kind, x, y, size) {
  const { color, shape } = verdicts[kind], r = size / 2;
  const path = () => {
    context.beginPath();
    if (shape === "circle") context.arc(x, y, r * 0.9, 0, 2 * Math.PI);
    else if (shape === "square") context.rect(x - r, y - r, size, size);
    else { context.moveTo(x - r, y - r); context.lineTo(x + r, y + r); context.moveTo(x - r, y + r); context.lineTo(x + r, y - r); }
  };
  if (size < 6) { context.fillStyle = color; path(); context.fill(); return; }
  const line = clamp(size / 8, 1.5, 4);
  for (const [style, w] of [["rgb(0 0 0 / 0.75)", line + 2], [color, line]]) {
    context.strokeStyle = style;
    context.lineWidth = w;
    path();
    context.stroke();
  }
}

// A frame around the inspected pixel, dark within light: seen on any ground.
function drawCursor(context, pane) {
  if (state.px < 0) return;
  const z = zoomNow(), [x, y] = toStage(pane, state.px, state.py), size = Math.max(z, 9), pad = (size - z) / 2;
  context.save();
  context.beginPath();
  context.rect(pane.x, pane.y, pane.w, pane.h);
  context.clip();
  for (const [style, w] of [["#000", 4], ["#fff", 2]]) {
    context.strokeStyle = style;
    context.lineWidth = w;
    context.strokeRect(x - pad, y - pad, size, size);
  }
  context.restore();
}

// ---- hands

const pointers = new Map();
let drag = null, held = false; // a clicked pixel is held until the next click

function stagePoint(event) {
  const box = canvas.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}
const spread = () => {
  const [p, q] = [...pointers.values()];
  return { x: (p[0] + q[0]) / 2, y: (p[1] + q[1]) / 2, d: Math.hypot(p[0] - q[0], p[1] - q[1]) };
};

function setSplit(value) {
  state.split = clamp(value, 0, 1);
  changed();
}

canvas.addEventListener("pointerdown", event => {
  const at = stagePoint(event);
  canvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, at);
  if (pointers.size === 2) { drag = { kind: "pinch", ...spread() }; return; }
  drag = { kind: state.mode === "split" && fitted() ? "split" : "pan", from: at, last: at, moved: false };
});
canvas.addEventListener("pointermove", event => {
  const at = stagePoint(event);
  if (pointers.has(event.pointerId)) pointers.set(event.pointerId, at);
  if (drag && drag.kind === "pinch" && pointers.size >= 2) {
    const now = spread();
    state.x -= (now.x - drag.x) / zoomNow();
    state.y -= (now.y - drag.y) / zoomNow();
    zoomAt(now.d / Math.max(drag.d, 1), now.x, now.y);
    Object.assign(drag, now);
    changed();
  } else if (drag && drag.from) {
    if (Math.hypot(at[0] - drag.from[0], at[1] - drag.from[1]) > 4) drag.moved = true;
    if (!drag.moved) return;
    if (drag.kind === "split") setSplit(at[0] / stageWidth);
    else {
      state.x -= (at[0] - drag.last[0]) / zoomNow();
      state.y -= (at[1] - drag.last[1]) / zoomNow();
      drag.last = at;
      settle();
      changed();
    }
  } else if (!held && event.pointerType === "mouse") inspectAt(at);
});
const release = event => {
  const at = stagePoint(event);
  if (drag && drag.from && !drag.moved && event.type === "pointerup") {
    const before = `${state.px},${state.py}`, wasHeld = held;
    held = false;
    inspectAt(at);
    held = !(wasHeld && before === `${state.px},${state.py}`); // a second click lets go
  }
  pointers.delete(event.pointerId);
  drag = null;
};
canvas.addEventListener("pointerup", release);
canvas.addEventListener("pointercancel", release);

// The wheel zooms; where the picture already fits, turning it further scrolls the page.
canvas.addEventListener("wheel", event => {
  if (event.deltaY > 0 && fitted() && !event.ctrlKey) return;
  event.preventDefault();
  const step = event.deltaMode === 1 ? 16 : 1;
  zoomAt(Math.exp(-event.deltaY * step * (event.ctrlKey ? 0.01 : 0.0022)), ...stagePoint(event));
  changed();
}, { passive: false });

const handle = element("handle");
handle.addEventListener("pointerdown", event => { handle.setPointerCapture(event.pointerId); event.preventDefault(); handle.focus({ preventScroll: true }); });
handle.addEventListener("pointermove", event => {
  if (handle.hasPointerCapture(event.pointerId)) setSplit((event.clientX - stage.getBoundingClientRect().left) / stageWidth);
});
handle.addEventListener("keydown", event => {
  const step = { ArrowLeft: -0.02, ArrowDown: -0.02, ArrowRight: 0.02, ArrowUp: 0.02, PageDown: -0.1, PageUp: 0.1, Home: -1, End: 1 }[event.key];
  if (step === undefined) return;
  event.preventDefault();
  event.stopPropagation();
  setSplit(state.split + step);
});

function inspectAt([sx, sy]) {
  const [x, y] = toPicture(sx, sy).map(Math.floor);
  if (x < 0 || y < 0 || x >= width || y >= height) return;
  inspect(x, y);
}

function inspect(x, y, announce = false) {
  if (x === state.px && y === state.py) return;
  state.px = x;
  state.py = y;
  showInspector(announce);
  redraw();
  writeAddress();
}

// Chooses a pixel by keyboard and brings it into sight.
function moveTo(x, y, zoom = 0) {
  held = true;
  if (zoom) state.zoom = Math.max(zoomNow(), zoom);
  const pane = panes()[0], z = zoomNow();
  if (zoom || Math.abs(x - state.x) > pane.w / z / 2 - 1) state.x = x + 0.5;
  if (zoom || Math.abs(y - state.y) > pane.h / z / 2 - 1) state.y = y + 0.5;
  settle();
  inspect(clamp(x, 0, width - 1), clamp(y, 0, height - 1), true);
  changed();
}

// To the next pixel whose hits differ: the unexplained first, then ties, then edges.
function nextDisagreement(step) {
  if (!disagreeing.length) return;
  const here = disagreeing.indexOf(state.py * width + state.px);
  const next = here < 0 ? (step > 0 ? 0 : disagreeing.length - 1) : (here + step + disagreeing.length) % disagreeing.length;
  const i = disagreeing[next];
  moveTo(i % width, Math.floor(i / width), 24);
}
