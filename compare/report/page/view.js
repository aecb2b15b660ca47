// ---- view.js: which part of the picture is seen, how large; and what the page's address says of it.

// All that can be linked to. Zoom is in screen pixels a picture pixel; 0 fits the picture.
const state = {
  mode: "split", split: 0.5, zoom: 0, x: width / 2, y: height / 2, ev: 0, range: 0, channel: "luminance", palette: "hue",
  show: "a", play: true, px: -1, py: -1, theme: "auto", period: 700,
};
const modes = ["split", "flicker", "side", "difference", "hits"];
const defaults = { ...state };
const clamp = (v, low, high) => Math.min(Math.max(v, low), high);

function readAddress() {
  Object.assign(state, defaults); // what the address doesn't say is as at the start
  for (const [key, text] of new URLSearchParams(location.hash.slice(1))) {
    if (!(key in defaults)) continue;
    const kind = typeof defaults[key];
    if (kind === "boolean") state[key] = text !== "false" && text !== "0";
    else if (kind === "string") state[key] = text;
    else if (Number.isFinite(Number(text))) state[key] = Number(text);
  }
  if (!modes.includes(state.mode)) state.mode = "split";
  if (!(state.channel in channels)) state.channel = "luminance";
  if (!(state.palette in anchors)) state.palette = "hue";
  if (!["auto", "light", "dark"].includes(state.theme)) state.theme = "auto";
  state.split = clamp(state.split, 0, 1);
  state.ev = clamp(state.ev, -8, 8);
  state.period = clamp(state.period, 350, 2000);
  state.zoom = state.zoom <= 0 ? 0 : clamp(state.zoom, 0.01, maxZoom);
}

let addressTimer = 0;
function writeAddress() {
  clearTimeout(addressTimer);
  addressTimer = setTimeout(() => {
    const parts = [];
    for (const key of Object.keys(defaults)) {
      if (state[key] === defaults[key] || (state.zoom === 0 && (key === "x" || key === "y"))) continue;
      parts.push(`${key}=${typeof state[key] === "number" ? +state[key].toPrecision(5) : state[key]}`);
    }
    history.replaceState(null, "", parts.length ? "#" + parts.join("&") : location.pathname + location.search);
  }, 250);
}

const maxZoom = 128;
const stage = document.getElementById("stage"), canvas = document.getElementById("canvas");
let stageWidth = 1, stageHeight = 1; // CSS pixels

// Side by side where there is room, one above the other on a narrow screen.
const stacked = () => stageWidth < 620;

// The rectangles pictures are shown in: one, or two side by side.
function panes() {
  if (state.mode !== "side") return [{ x: 0, y: 0, w: stageWidth, h: stageHeight }];
  const gap = 2;
  if (stacked()) {
    const h = (stageHeight - gap) / 2;
    return [{ x: 0, y: 0, w: stageWidth, h }, { x: 0, y: h + gap, w: stageWidth, h }];
  }
  const w = (stageWidth - gap) / 2;
  return [{ x: 0, y: 0, w, h: stageHeight }, { x: w + gap, y: 0, w, h: stageHeight }];
}

// The stage takes the picture's shape, but never more of the window than leaves its controls in sight.
function layoutStage() {
  stageWidth = stage.clientWidth;
  const columns = state.mode === "side" && !stacked() ? 2 : 1, rows = state.mode === "side" && stacked() ? 2 : 1;
  const tall = stageWidth / columns * height / width * rows;
  stageHeight = Math.round(clamp(tall, 160, Math.max(300, window.innerHeight * 0.74)));
  const ratio = window.devicePixelRatio || 1;
  canvas.style.height = `${stageHeight}px`;
  canvas.width = Math.round(stageWidth * ratio);
  canvas.height = Math.round(stageHeight * ratio);
}

function fitZoom() {
  const pane = panes()[0];
  return Math.min(pane.w / width, pane.h / height);
}
const zoomNow = () => state.zoom || fitZoom();
const fitted = () => zoomNow() <= fitZoom() * 1.001;

// Keeps the picture from leaving its pane; where it is smaller than the pane, it is centred.
function settle() {
  const pane = panes()[0];
  if (state.zoom && state.zoom <= fitZoom() * 1.001) state.zoom = 0;
  const z = zoomNow(), halfWidth = pane.w / z / 2, halfHeight = pane.h / z / 2;
  state.x = halfWidth * 2 >= width ? width / 2 : clamp(state.x, halfWidth, width - halfWidth);
  state.y = halfHeight * 2 >= height ? height / 2 : clamp(state.y, halfHeight, height - halfHeight);
}

const paneAt = (sx, sy) => panes().find(p => sx >= p.x && sx < p.x + p.w && sy >= p.y && sy < p.y + p.h) || panes()[0];
// From a place on the stage to one in the picture, and back.
function toPicture(sx, sy) {
  const p = paneAt(sx, sy), z = zoomNow();
  return [(sx - p.x - p.w / 2) / z + state.x, (sy - p.y - p.h / 2) / z + state.y];
}
function toStage(pane, x, y) {
  const z = zoomNow();
  return [(x - state.x) * z + pane.x + pane.w / 2, (y - state.y) * z + pane.y + pane.h / 2];
}

// Zooms by a factor, what lies at (sx, sy) staying where it is.
function zoomAt(factor, sx = stageWidth / 2, sy = stageHeight / 2) {
  const before = toPicture(sx, sy);
  state.zoom = clamp(zoomNow() * factor, fitZoom(), maxZoom);
  const after = toPicture(sx, sy);
  state.x += before[0] - after[0];
  state.y += before[1] - after[1];
  settle();
}
