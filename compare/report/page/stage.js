// ---- stage.js: draws the stage.

const sides = data.sides.map((side, k) => ({ ...side, symbol: "▲●"[k], style: ["side-a", "side-b"][k] }));
const layers = {
  pictures: [newCanvas(), newCanvas()],
  difference: newCanvas(),
  flip: newCanvas(),
  ground: newCanvas(),
  veil: newCanvas()
};
let decoded = null, difference = null, disagreeing = [];
let lit = []; // pixels of the histogram's selected bin, largest error first

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
  const [first, second] = panes(), shownSide = state.show === "a" ? 0 : 1;
  const picture = (k, pane, window) =>
      drawLayer(context, layers.pictures[k], pane, window, i => decoded.pictures[k].rgb(i).map(pixelText));
  if (state.mode === "split") {
    const at = state.split * stageWidth;
    picture(1, first, { x: at, y: 0, w: stageWidth - at, h: stageHeight });
    picture(0, first, { x: 0, y: 0, w: at, h: stageHeight });
  } else if (state.mode === "side") {
    picture(0, first, first);
    picture(1, second, second);
  } else if (state.mode === "flicker") picture(shownSide, first, first);
  else if (state.mode === "difference")
    drawLayer(context, layers.difference, first, first, i => [signedText(difference[i])]);
  else if (state.mode === "flip") drawLayer(context, layers.flip, first, first, i => [radianceText(decoded.flip[i])]);
  else {
    drawLayer(context, layers.ground, first, first, hitTexts);
    drawMarks(context, first);
  }
  for (const pane of panes()) {
    if (state.bin >= 0) drawLit(context, pane);
    drawCursor(context, pane);
  }
}

function hitTexts(i) {
  const names = decoded.hits.of.map(hit => hit(i)).map(h => h.object ? `${h.object - 1}:${h.primitive}` : "–");
  return decoded.hits.verdict[i] ? names.map((name, k) => `${sides[k].symbol} ${name}`) : [names[0]];
}

// Draws a layer in a pane, clipped to `window`. From zoom 10 on it has a grid, from zoom 64 on a text in each pixel.
function drawLayer(context, layer, pane, window, texts) {
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
  if (z >= 64) drawTexts(context, layer, pane, z, texts);
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
  for (let x = x0; x <= x1; ++x) {
    const [sx] = toStage(pane, x, 0);
    context.moveTo(Math.round(sx) + 0.5, pane.y);
    context.lineTo(Math.round(sx) + 0.5, pane.y + pane.h);
  }
  for (let y = y0; y <= y1; ++y) {
    const [, sy] = toStage(pane, 0, y);
    context.moveTo(pane.x, Math.round(sy) + 0.5);
    context.lineTo(pane.x + pane.w, Math.round(sy) + 0.5);
  }
  context.stroke();
}

// Above this relative luminance black text has more contrast than white text: √(1.05 · 0.05) − 0.05 (WCAG 2.1).
const middleLuminance = 0.179;
const relativeLuminance = (r, g, b) =>
    luminance([r, g, b].map(byte => byte <= 10 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4));

function drawTexts(context, layer, pane, z, texts) {
  const { x0, x1, y0, y1 } = visiblePixels(pane), size = clamp(z / 6.4, 10, 16);
  const colors = layer.getContext("2d").getImageData(x0, y0, x1 - x0, y1 - y0).data;
  context.font = `${size}px ui-monospace, SFMono-Regular, Menlo, Consolas, monospace`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  for (let y = y0, at = 0; y < y1; ++y) for (let x = x0; x < x1; ++x, at += 4) {
    const [sx, sy] = toStage(pane, x + 0.5, y + 0.5), lines = texts(y * width + x);
    context.fillStyle =
        relativeLuminance(colors[at], colors[at + 1], colors[at + 2]) > middleLuminance ? "#000" : "#fff";
    lines.forEach((line, k) => context.fillText(line, sx, sy + (k - (lines.length - 1) / 2) * size * 1.3, z - 4));
  }
}

// Draws a mark for every pixel whose hits differ. Marks have a constant screen size until pixels are larger.
function drawMarks(context, pane) {
  const z = zoomNow();
  for (const kind of [1, 2, 3]) {
    if (!shown[kind]) continue;
    const size = Math.max([0, 4, 8, 12][kind], z * 0.8);
    for (const i of disagreeing) {
      if (decoded.hits.verdict[i] !== kind) continue;
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
    else {
      context.moveTo(x - r, y - r);
      context.lineTo(x + r, y + r);
      context.moveTo(x - r, y + r);
      context.lineTo(x + r, y - r);
    }
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

// Highlights the selected bin by covering all other pixels. If it has few pixels, each is framed to be easy to find.
function drawLit(context, pane) {
  const z = zoomNow(), [left, top] = toStage(pane, 0, 0), side = Math.max(z, 7), pad = (side - z) / 2;
  context.save();
  context.beginPath();
  context.rect(pane.x, pane.y, pane.w, pane.h);
  context.clip();
  context.imageSmoothingEnabled = z < 2;
  context.drawImage(layers.veil, left, top, width * z, height * z);
  if (lit.length <= 400) for (const [style, w] of [["#000", 3], ["#fff", 1]]) {
    context.strokeStyle = style;
    context.lineWidth = w;
    for (const i of lit) {
      const [x, y] = toStage(pane, i % width, Math.floor(i / width));
      context.strokeRect(x - pad, y - pad, side, side);
    }
  }
  context.restore();
}

// Draws a frame around the inspected pixel, dark inside light, so that it is visible on any background.
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
