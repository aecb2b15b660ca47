// ---- view.js: manages the visible part of the image, the zoom, and the state in the page's URL.

const modes = [
  { key: "split", title: "Split" },
  { key: "flicker", title: "Flicker" },
  { key: "side", title: "Side by side" },
  { key: "difference", title: "Difference" },
  { key: "flip", title: data.flip.name },
  ...(data.hits ? [{ key: "hits", title: "Hits" }] : []),
];

// This is the state that a link can contain, besides the theme. Zoom is in screen pixels per image pixel; 0 fits the
// image to the pane. `bin` is the histogram's selected bin; −1 means none.
const state = {
  mode: "split",
  split: 0.5,
  zoom: 0,
  x: width / 2,
  y: height / 2,
  ev: data.exposure,
  tone: data.tone,
  range: data.difference_range,
  channel: "luminance",
  palette: "hue",
  show: "a",
  play: !matchMedia("(prefers-reduced-motion: reduce)").matches,
  period: 700,
  px: -1,
  py: -1,
  histogram: "signed",
  bin: -1,
};
const defaults = { ...state };
const maxStops = Math.max(8, Math.ceil(Math.abs(defaults.ev))); // stops at the ends of the exposure slider

function readAddress() {
  Object.assign(state, defaults); // values that are not in the URL get their defaults
  for (const [key, text] of addressPairs()) {
    if (!Object.hasOwn(defaults, key)) continue;
    const kind = typeof defaults[key];
    if (kind === "boolean") state[key] = text !== "false" && text !== "0";
    else if (kind === "string") state[key] = text;
    else if (Number.isFinite(Number(text))) state[key] = Number(text);
  }
  if (!modes.some(mode => mode.key === state.mode)) state.mode = "split";
  if (!Object.hasOwn(data.tones, state.tone)) state.tone = defaults.tone;
  if (!Object.hasOwn(channels, state.channel)) state.channel = "luminance";
  if (!Object.hasOwn(palettes, state.palette)) state.palette = "hue";
  if (!Object.hasOwn(quantities, state.histogram)) state.histogram = "signed";
  if (!(state.range > 0)) state.range = defaults.range;
  if (state.show !== "b") state.show = "a";
  state.px = Math.round(state.px);
  state.py = Math.round(state.py);
  if (state.px < 0 || state.py < 0 || state.px >= width || state.py >= height) state.px = state.py = -1;
  state.bin = Math.max(Math.round(state.bin), -1);
  state.range = clamp(state.range, 1e-4, 100);
  state.split = clamp(state.split, 0, 1);
  state.ev = clamp(state.ev, -maxStops, maxStops);
  state.period = clamp(state.period, 350, 2000);
  state.zoom = state.zoom <= 0 ? 0 : clamp(state.zoom, 0.01, maxZoom);
}

let addressTimer = 0;
function writeAddress() {
  clearTimeout(addressTimer);
  addressTimer = setTimeout(() => {
    const said = key => state[key] !== defaults[key] && !(state.zoom === 0 && (key === "x" || key === "y"));
    const short = value => typeof value === "number" ? +value.toPrecision(7) : value;
    setAddress(Object.keys(defaults).filter(said).map(key => [key, short(state[key])]));
  }, 250);
}

const maxZoom = 128;
const stage = element("stage"), canvas = element("canvas");
let stageWidth = 1, stageHeight = 1; // in CSS pixels

// Returns whether panes are stacked vertically, as on a narrow screen, instead of side by side.
const stacked = () => stageWidth < 620;

// Returns the rectangles in which images are shown: one, or two for comparison.
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

// Gives the stage the image's aspect ratio, limited in height so that the controls stay in view.
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

// Keeps the image within its pane. If it is smaller than the pane, it is centered.
function settle() {
  const pane = panes()[0];
  if (state.zoom && state.zoom <= fitZoom() * 1.001) state.zoom = 0;
  const z = zoomNow(), halfWidth = pane.w / z / 2, halfHeight = pane.h / z / 2;
  state.x = halfWidth * 2 >= width ? width / 2 : clamp(state.x, halfWidth, width - halfWidth);
  state.y = halfHeight * 2 >= height ? height / 2 : clamp(state.y, halfHeight, height - halfHeight);
}

const paneAt = (sx, sy) => panes().find(p => sx >= p.x && sx < p.x + p.w && sy >= p.y && sy < p.y + p.h) || panes()[0];
// These two functions convert a position on the stage to one in the image, and back.
function toImage(sx, sy) {
  const p = paneAt(sx, sy), z = zoomNow();
  return [(sx - p.x - p.w / 2) / z + state.x, (sy - p.y - p.h / 2) / z + state.y];
}
function toStage(pane, x, y) {
  const z = zoomNow();
  return [(x - state.x) * z + pane.x + pane.w / 2, (y - state.y) * z + pane.y + pane.h / 2];
}

// Zooms by a factor and keeps the point at (sx, sy) in place.
function zoomAt(factor, sx = stageWidth / 2, sy = stageHeight / 2) {
  const before = toImage(sx, sy);
  state.zoom = clamp(zoomNow() * factor, fitZoom(), maxZoom);
  const after = toImage(sx, sy);
  state.x += before[0] - after[0];
  state.y += before[1] - after[1];
  settle();
}
