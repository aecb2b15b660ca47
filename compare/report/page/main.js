// ---- main.js: the controls, and the start.

function changed() {
  settle();
  const z = zoomNow();
  element("zoom-value").textContent = `${Math.round(z * 100)} %`;
  const atSplit = state.mode === "split";
  handle.hidden = !atSplit;
  handle.style.left = `${state.split * 100}%`;
  handle.setAttribute("aria-valuenow", Math.round(state.split * 100));
  handle.setAttribute("aria-valuetext", `rasterizer on the left ${Math.round(state.split * 100)} percent`);
  // At rest a finger scrolls the page up and down; zoomed in, it moves the picture.
  canvas.style.touchAction = fitted() ? "pan-y" : "none";
  redraw();
  writeAddress();
}

function showChips() {
  const a = element("chip-a"), b = element("chip-b"), flicker = state.mode === "flicker";
  a.hidden = !(state.mode === "split" || state.mode === "side" || (flicker && state.show === "a"));
  b.hidden = !(state.mode === "split" || state.mode === "side" || (flicker && state.show === "b"));
  b.classList.toggle("alone", flicker);
  const below = state.mode === "side" && stacked();
  b.style.top = below ? `${panes()[1].y + 12}px` : "";
  b.style.left = below ? "12px" : "";
  b.style.right = below ? "auto" : "";
}

const captions = {
  split: "Drag the line. Left of it the rasterizer's picture, right of it the path tracer's.",
  flicker: "One picture after the other: what moves or changes shade differs.",
  side: "Both pictures move and zoom together.",
  difference: "",
  hits: "",
};

function setMode(mode) {
  state.mode = mode;
  for (const button of element("modes").children) button.setAttribute("aria-pressed", String(button.dataset.mode === mode));
  for (const field of document.querySelectorAll("[data-for]")) field.hidden = !field.dataset.for.split(" ").includes(mode);
  element("caption").textContent = captions[mode];
  layoutStage();
  if (mode === "difference") updateDifference();
  if (mode === "hits") captionHits();
  showChips();
  changed();
}

function captionHits() {
  element("steps").hidden = !disagreeing.length;
  element("caption").textContent = disagreeing.length
    ? "Marked: pixels where the two see different primitives."
    : "Both pipelines see the same primitive in every pixel.";
}

// ---- exposure, difference, flicker

function updateExposure() {
  element("exposure").value = state.ev;
  element("exposure-value").textContent = minus(`${state.ev > 0 ? "+" : ""}${state.ev.toFixed(1)} EV`);
  paintPicture(layers.a, decoded.raster, state.ev);
  paintPicture(layers.b, decoded.raytrace, state.ev);
  showInspector();
}

function automaticRange() { return report.difference_range > 0 ? report.difference_range : 0.001; }

function updateDifference() {
  const beyond = paintDifference(layers.difference, difference, state.range, state.palette);
  element("range").value = Math.log10(state.range);
  element("range-value").textContent = radianceText(state.range);
  element("channel").value = state.channel;
  element("palette").value = state.palette;
  const scale = element("scale").getContext("2d");
  for (let x = 0; x < 512; ++x) {
    scale.fillStyle = `rgb(${falseColor(state.palette, x / 511 * 2 - 1).join(" ")})`;
    scale.fillRect(x, 0, 1, 14);
  }
  fill("ticks", ...[-1, -0.5, 0, 0.5, 1].map(f => make("span", {}, f === 0 ? "0" : minus((f > 0 ? "+" : "") + Number((f * state.range).toPrecision(2))))));
  element("caption").textContent = `Rasterizer minus path tracer, ${state.channel === "luminance" ? "luminance" : element("channel").selectedOptions[0].textContent}, linear. `
    + (beyond > 0 ? `${percentText(beyond)} of the pixels lie beyond the scale's ends.` : "No pixel lies beyond the scale's ends.");
  showInspector();
}

let flickerTimer = 0;
function swap() {
  state.show = state.show === "a" ? "b" : "a";
  showChips();
  redraw();
}
function updateFlicker() {
  clearInterval(flickerTimer);
  if (state.play) flickerTimer = setInterval(() => { if (state.mode === "flicker") swap(); }, state.period);
  element("flicker-play").textContent = state.play ? "Pause" : "Play";
  element("flicker-play").setAttribute("aria-pressed", String(state.play));
  element("period").value = state.period;
  element("period-value").textContent = `${(state.period / 1000).toFixed(2)} s`;
}

function applyTheme() {
  if (state.theme === "auto") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = state.theme;
  element("theme").textContent = `Theme: ${state.theme}`;
}

// ---- wiring

function setExposure(ev) { state.ev = clamp(Math.round(ev * 10) / 10, -8, 8); updateExposure(); changed(); }
function swapByHand() { state.play = false; updateFlicker(); if (state.mode !== "flicker") setMode("flicker"); swap(); writeAddress(); }

function wire() {
  for (const button of element("modes").children) button.addEventListener("click", () => setMode(button.dataset.mode));
  element("zoom-in").addEventListener("click", () => { zoomAt(2); changed(); });
  element("zoom-out").addEventListener("click", () => { zoomAt(0.5); changed(); });
  element("zoom-fit").addEventListener("click", () => { state.zoom = 0; changed(); });
  element("exposure").addEventListener("input", event => setExposure(Number(event.target.value)));
  element("exposure").addEventListener("dblclick", () => setExposure(0));
  element("range").addEventListener("input", event => { state.range = 10 ** Number(event.target.value); updateDifference(); changed(); });
  element("channel").addEventListener("change", event => { state.channel = event.target.value; difference = differences(state.channel); updateDifference(); changed(); });
  element("palette").addEventListener("change", event => { state.palette = event.target.value; updateDifference(); changed(); });
  element("flicker-play").addEventListener("click", () => { state.play = !state.play; updateFlicker(); writeAddress(); });
  element("flicker-swap").addEventListener("click", swapByHand);
  element("next").addEventListener("click", () => nextDisagreement(1));
  element("previous").addEventListener("click", () => nextDisagreement(-1));
  element("period").addEventListener("input", event => { state.period = Number(event.target.value); updateFlicker(); writeAddress(); });
  element("theme").addEventListener("click", () => { state.theme = { auto: "light", light: "dark", dark: "auto" }[state.theme]; applyTheme(); writeAddress(); });
  fill("marks", ...[1, 2, 3].map(kind => {
    const box = make("input", { type: "checkbox", checked: "" });
    box.addEventListener("change", () => { shown[kind] = box.checked; redraw(); });
    return make("label", {}, box, symbolOf(kind), `${verdicts[kind].title} ${countText(report.hits[verdicts[kind].key])}`);
  }));
  canvas.addEventListener("keydown", stageKey);
  document.addEventListener("keydown", pageKey);
  window.addEventListener("resize", () => { layoutStage(); showChips(); changed(); });
  window.addEventListener("hashchange", () => { readAddress(); refresh(); });
}

function stageKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  if (!step) return;
  event.preventDefault();
  const size = event.shiftKey ? 10 : 1;
  if (state.px < 0) moveTo(Math.floor(state.x), Math.floor(state.y));
  else moveTo(clamp(state.px + step[0] * size, 0, width - 1), clamp(state.py + step[1] * size, 0, height - 1));
}

function pageKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
  const onButton = /^(BUTTON|SUMMARY|A)$/.test(event.target.tagName);
  const actions = {
    1: () => setMode(modes[0]), 2: () => setMode(modes[1]), 3: () => setMode(modes[2]), 4: () => setMode(modes[3]), 5: () => setMode(modes[4]),
    f: () => setMode("flicker"), n: () => nextDisagreement(1), p: () => nextDisagreement(-1),
    "[": () => setExposure(state.ev - 0.5), "]": () => setExposure(state.ev + 0.5),
    ",": () => setSplit(state.split - 0.05), ".": () => setSplit(state.split + 0.05),
    "+": () => { zoomAt(2); changed(); }, "=": () => { zoomAt(2); changed(); }, "-": () => { zoomAt(0.5); changed(); },
    0: () => { state.zoom = 0; changed(); },
  };
  if (!onButton) actions[" "] = swapByHand;
  const action = actions[event.key.toLowerCase()];
  if (!action) return;
  event.preventDefault();
  action();
}

// Brings everything in line with the state.
function refresh() {
  applyTheme();
  if (state.px >= width || state.py >= height) state.px = state.py = -1;
  held = state.px >= 0;
  difference = differences(state.channel);
  if (!(state.range > 0)) state.range = defaults.range = automaticRange();
  updateExposure();
  updateFlicker();
  setMode(state.mode);
  showInspector();
}

async function start() {
  readAddress();
  applyTheme();
  layoutStage();
  showLede();
  showHits();
  showMetrics();
  showTimes();
  showSkipped();
  showFacts();
  try {
    decoded = await decodeAll();
  } catch (error) {
    element("loading").textContent = `The pictures could not be unpacked: ${error.message}. A browser from 2023 or later is needed.`;
    return;
  }
  for (let i = 0; i < pixelCount; ++i) if (decoded.verdict[i]) disagreeing.push(i);
  disagreeing.sort((i, j) => decoded.verdict[j] - decoded.verdict[i] || i - j);
  paintGround(layers.ground, decoded.raster);
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) state.play = false;
  element("loading").hidden = true;
  wire();
  refresh();
  document.documentElement.dataset.ready = "yes";
}
start();
