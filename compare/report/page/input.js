// ---- input.js: handles input on the stage: pointers, wheel, keys, and stepping between pixels.

const handle = element("handle");
const pointers = new Map(); // active pointers on the stage, with their positions
let drag = null, held = false; // a clicked pixel stays selected until the next click

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

function pointerDown(event) {
  const at = stagePoint(event);
  canvas.setPointerCapture(event.pointerId);
  pointers.set(event.pointerId, at);
  if (pointers.size === 2) { drag = { kind: "pinch", ...spread() }; return; }
  drag = { kind: state.mode === "split" && fitted() ? "split" : "pan", from: at, last: at, moved: false };
}

function pointerMove(event) {
  const at = stagePoint(event);
  if (pointers.has(event.pointerId)) pointers.set(event.pointerId, at);
  if (drag && drag.kind === "pinch" && pointers.size >= 2) pinch(spread());
  else if (drag && drag.from) dragTo(at);
  else if (!held && event.pointerType === "mouse") inspectAt(at);
}

function pinch(now) {
  state.x -= (now.x - drag.x) / zoomNow();
  state.y -= (now.y - drag.y) / zoomNow();
  zoomAt(now.d / Math.max(drag.d, 1), now.x, now.y);
  Object.assign(drag, now);
  changed();
}

function dragTo(at) {
  if (Math.hypot(at[0] - drag.from[0], at[1] - drag.from[1]) > 4) drag.moved = true;
  if (!drag.moved) return;
  if (drag.kind === "split") { setSplit(at[0] / stageWidth); return; }
  state.x -= (at[0] - drag.last[0]) / zoomNow();
  state.y -= (at[1] - drag.last[1]) / zoomNow();
  drag.last = at;
  changed();
}

function pointerUp(event) {
  if (drag && drag.from && !drag.moved && event.type === "pointerup") {
    const before = `${state.px},${state.py}`, wasHeld = held;
    held = false;
    inspectAt(stagePoint(event));
    held = !(wasHeld && before === `${state.px},${state.py}`); // a second click releases the pixel
  }
  pointers.delete(event.pointerId);
  drag = null;
}

// The wheel zooms. When the image already fits, scrolling further scrolls the page.
function wheel(event) {
  if (event.deltaY > 0 && fitted() && !event.ctrlKey) return;
  event.preventDefault();
  const unit = event.deltaMode === 1 ? 16 : 1;
  zoomAt(Math.exp(-event.deltaY * unit * (event.ctrlKey ? 0.01 : 0.0022)), ...stagePoint(event));
  changed();
}

function handleKey(event) {
  const by = {
    ArrowLeft: -0.02,
    ArrowDown: -0.02,
    ArrowRight: 0.02,
    ArrowUp: 0.02,
    PageDown: -0.1,
    PageUp: 0.1,
    Home: -1,
    End: 1
  }[event.key];
  if (by === undefined) return;
  event.preventDefault();
  setSplit(state.split + by);
}

// The arrow keys select a pixel, starting from the middle of the visible part. With Shift they move by ten pixels.
function stageKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const by = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  if (!by) return;
  event.preventDefault();
  const size = event.shiftKey ? 10 : 1;
  if (state.px < 0) moveTo(Math.floor(state.x), Math.floor(state.y));
  else moveTo(clamp(state.px + by[0] * size, 0, width - 1), clamp(state.py + by[1] * size, 0, height - 1));
}

function wireStage() {
  canvas.addEventListener("pointerdown", pointerDown);
  canvas.addEventListener("pointermove", pointerMove);
  canvas.addEventListener("pointerup", pointerUp);
  canvas.addEventListener("pointercancel", pointerUp);
  canvas.addEventListener("wheel", wheel, { passive: false });
  canvas.addEventListener("keydown", stageKey);
  handle.addEventListener("pointerdown", event => {
    handle.setPointerCapture(event.pointerId);
    event.preventDefault();
    handle.focus({preventScroll: true});
  });
  handle.addEventListener("pointermove", event => {
    if (handle.hasPointerCapture(event.pointerId))
      setSplit((event.clientX - stage.getBoundingClientRect().left) / stageWidth);
  });
  handle.addEventListener("keydown", handleKey);
}

// ---- The selected pixel

function inspectAt([sx, sy]) {
  const [x, y] = toImage(sx, sy).map(Math.floor);
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

// Selects a pixel by keyboard and scrolls it into view.
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

// Selects the next pixel of the selected bin. If no bin is selected, selects the next pixel whose hits differ:
// unexplained ones first, then ties, then edges.
function step(by) {
  const list = state.bin >= 0 ? lit : disagreeing;
  if (!list.length) return;
  const here = list.indexOf(state.py * width + state.px);
  const i = list[here < 0 ? (by > 0 ? 0 : list.length - 1) : (here + by + list.length) % list.length];
  moveTo(i % width, Math.floor(i / width), 24);
}
