// ---- main.js: connects the controls and starts the page.

function changed() {
  settle();
  element("zoom-value").textContent = `${Math.round(zoomNow() * 100)} %`;
  handle.hidden = state.mode !== "split";
  handle.style.left = `${state.split * 100}%`;
  handle.setAttribute("aria-valuenow", Math.round(state.split * 100));
  handle.setAttribute("aria-valuetext", `${sides[0].name} on the left ${Math.round(state.split * 100)} percent`);
  // When the image fits, a touch drag scrolls the page vertically. When zoomed in, it pans the image.
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
  split: () =>
      `Drag the line. Left of it ${sides[0].symbol} ${sides[0].name}, right of it ${sides[1].symbol} ${sides[1].name}.`,
  flicker: () => "One image after the other: what moves or changes shade differs.",
  side: () => "Both images move and zoom together.",
  difference: () => "",
  flip: () => `How visible the difference is to someone who alternates between the images (Andersson et al. ${
      data.eight_bit ? "2020" : "2021"}).`,
  hits: () => disagreeing.length ? "Marked: pixels where the two see different primitives." :
                                   "Both pipelines see the same primitive in every pixel.",
};

function setMode(mode) {
  state.mode = mode;
  for (const button of element("modes").children)
    button.setAttribute("aria-pressed", String(button.dataset.mode === mode));
  for (const field of document.querySelectorAll("[data-for]"))
    field.hidden = !field.dataset.for.split(" ").includes(mode);
  element("caption").textContent = captions[mode]();
  layoutStage();
  if (mode === "difference") updateDifference();
  if (mode === "flip") updateFlip();
  showSteps();
  showChips();
  changed();
}

// Shows the buttons for the previous and next pixel if there are such pixels.
function showSteps() {
  const list = state.bin >= 0 ? lit : state.mode === "hits" ? disagreeing : [];
  element("steps").hidden = state.bin < 0 && !list.length;
  element("previous").hidden = element("next").hidden = !list.length;
  element("show-all").hidden = state.bin < 0;
  element("steps-text").textContent = state.bin < 0 ? "" :
      list.length === 1                             ? "Lit: 1 pixel" :
                                                      `Lit: ${countText(list.length)} pixels`;
}

// ---- Exposure, difference, FLIP, flicker

function updateExposure() {
  element("exposure").value = state.ev;
  element("tone").value = state.tone;
  element("exposure-value").textContent = minus(`${state.ev > 0 ? "+" : ""}${state.ev.toFixed(1)} EV`);
  layers.pictures.forEach((layer, k) => paintImage(layer, decoded.pictures[k], state.ev));
  showInspector();
}

function drawScale(color, ticks, ends) {
  const scale = element("scale").getContext("2d");
  for (let x = 0; x < 512; ++x) {
    scale.fillStyle = css(color(x / 511));
    scale.fillRect(x, 0, 1, 14);
  }
  fill("ticks", ...ticks.map(text => make("span", {}, text)));
  fill("ends", ...ends.map(text => make("span", {}, text)));
  element("palette").value = state.palette;
  element("palette").options[0].textContent =
      state.mode === "flip" ? "dark violet – pale yellow" : "blue – white – orange";
}

function updateDifference() {
  const beyond = paintValues(layers.difference, difference, -state.range, state.range, palettes[state.palette].signed);
  element("range").value = Math.log10(state.range);
  element("range-value").textContent = radianceText(state.range);
  element("channel").value = state.channel;
  drawScale(
      f => signedColor(2 * f - 1),
      [-1, -0.5, 0, 0.5,
       1].map(f => f === 0 ? "0" : minus((f > 0 ? "+" : "") + Number((f * state.range).toPrecision(2)))),
      [`${sides[1].symbol} ${sides[1].name} brighter`, `${sides[0].name} brighter ${sides[0].symbol}`]);
  element("caption").textContent =
      `${sides[0].name} minus ${sides[1].name}, ${element("channel").selectedOptions[0].textContent}, linear. ` +
      (beyond > 0 ? `${percentText(beyond / pixelCount)} of the pixels lie beyond the scale's ends.` :
                    "No pixel lies beyond the scale's ends.");
  showInspector();
}

function updateFlip() {
  paintValues(layers.flip, decoded.flip, 0, 1, palettes[state.palette].error);
  drawScale(errorColor, ["0", "0.25", "0.5", "0.75", "1"], ["not seen", "seen at once"]);
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
  element("period").value = state.period;
  element("period-value").textContent = `${(state.period / 1000).toFixed(2)} s`;
}

// Selects the pixel with the largest error of the kind that the stage shows: FLIP, or the difference.
function showWorst() {
  const values = state.mode === "flip" ? decoded.flip : difference;
  let worst = -1;
  for (let i = 0; i < pixelCount; ++i)
    if (Number.isFinite(values[i]) && (worst < 0 || Math.abs(values[i]) > Math.abs(values[worst]))) worst = i;
  if (worst >= 0) moveTo(worst % width, Math.floor(worst / width), 24);
}

// ---- Event handlers

function setExposure(ev) {
  state.ev = clamp(Math.round(ev * 10) / 10, -maxStops, maxStops);
  updateExposure();
  changed();
}
function setTone(tone) { state.tone = tone; updateExposure(); changed(); }
function setChannel(channel) {
  state.channel = channel;
  difference = channelOf(decoded.difference, channel);
  updateDifference();
  changed();
}
function setPalette(palette) { state.palette = palette; setMode(state.mode); showHistogram(); }
function swapByHand() {
  state.play = false;
  updateFlicker();
  if (state.mode !== "flicker") setMode("flicker");
  swap();
  writeAddress();
}
function zoomBy(factor) { zoomAt(factor); changed(); }
function fitAgain() { state.zoom = 0; changed(); }

function wire() {
  const on = (id, kind, act) => element(id).addEventListener(kind, event => act(event.target.value));
  for (const button of element("modes").children) button.addEventListener("click", () => setMode(button.dataset.mode));
  on("zoom-in", "click", () => zoomBy(2));
  on("zoom-out", "click", () => zoomBy(0.5));
  on("zoom-fit", "click", fitAgain);
  on("exposure", "input", value => setExposure(Number(value)));
  on("exposure", "dblclick", () => setExposure(defaults.ev));
  on("tone", "change", setTone);
  on("range", "input", value => { state.range = Number((10 ** value).toPrecision(3)); updateDifference(); changed(); });
  on("channel", "change", setChannel);
  on("palette", "change", setPalette);
  on("flicker-play", "click", () => { state.play = !state.play; updateFlicker(); writeAddress(); });
  on("flicker-swap", "click", swapByHand);
  on("period", "input", value => { state.period = Number(value); updateFlicker(); writeAddress(); });
  on("worst", "click", showWorst);
  on("next", "click", () => step(1));
  on("previous", "click", () => step(-1));
  on("show-all", "click", () => { chooseBin(-1); canvas.focus({ preventScroll: true }); });
  wireHistogram();
  wireStage();
  document.addEventListener("keydown", pageKey);
  window.addEventListener("resize", () => { layoutStage(); showChips(); changed(); });
  window.addEventListener("hashchange", () => { readAddress(); refresh(); });
}

function pageKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
  const onButton = /^(BUTTON|SUMMARY|A)$/.test(event.target.tagName);
  const actions = {
    f: () => setMode("flicker"), n: () => step(1), p: () => step(-1), w: showWorst,
    "[": () => setExposure(state.ev - 0.5), "]": () => setExposure(state.ev + 0.5),
    ",": () => setSplit(state.split - 0.05), ".": () => setSplit(state.split + 0.05),
    "+": () => zoomBy(2), "=": () => zoomBy(2), "-": () => zoomBy(0.5), 0: fitAgain,
    ...Object.fromEntries(modes.map((mode, k) => [k + 1, () => setMode(mode.key)])),
  };
  if (!onButton) actions[" "] = swapByHand;
  const action = actions[event.key.toLowerCase()];
  if (!action) return;
  event.preventDefault();
  action();
}

// ---- Start-up

// Fills in the content that depends on the page's data but not on its state.
function fillIn() {
  fill(
      "modes",
      ...modes.map(
          (mode, k) => make(
              "button", {type: "button", "data-mode": mode.key, "aria-keyshortcuts": k + 1, "aria-pressed": "false"},
              mode.title)));
  ["chip-a", "chip-b"].forEach(
      (id, k) => fill(id, make("i", {"aria-hidden": "true"}, sides[k].symbol), ` ${sides[k].name}`));
  Object.assign(element("exposure"), { min: -maxStops, max: maxStops });
  fill("tone", ...Object.keys(data.tones).map(name => make("option", { value: name }, name)));
  element("mode-keys").textContent = `1 – ${modes.length}`;
  element("mode-names").textContent = modes.map(mode => mode.title.toLowerCase()).join(", ");
  showSections();
  showSummary();
  showMetrics();
  if (data.hits) {
    showHits();
    fill("marks", ...[1, 2, 3].map(kind => {
      const box = make("input", { type: "checkbox", checked: "" });
      box.addEventListener("change", () => { shown[kind] = box.checked; redraw(); });
      return make(
          "label", {}, box, symbolOf(kind),
          `${verdicts[kind].title} ${countText(data.hits.figures[verdicts[kind].key])}`);
    }));
  }
  if (rendered) {
    showTimes();
    showSkipped();
    showFacts();
  }
}

// Updates everything to match the state.
function refresh() {
  held = state.px >= 0;
  difference = channelOf(decoded.difference, state.channel);
  countBins();
  updateExposure();
  updateFlicker();
  showHistogram();
  setMode(state.mode);
}

// Shows how many pixels exceed half precision. The metrics are computed from the original values.
function showBeyond() {
  let count = 0;
  for (let i = 0; i < pixelCount; ++i) count += decoded.pictures.some(picture => picture.isBeyond(i));
  element("beyond").hidden = count === 0;
  element("beyond").textContent = `${countText(count)} ${count === 1 ? "pixel holds" : "pixels hold"} values of ${
      countText(
          largestHalf)} or more, the largest number that this page keeps (half precision):
              they stand on it as that. The figures are of the values themselves.`;
}

async function start() {
  startTheme();
  readAddress();
  layoutStage();
  fillIn();
  try {
    decoded = await decodeAll();
  } catch (error) {
    element("loading").textContent =
        `The images could not be unpacked: ${error.message}. A browser from 2023 or later is needed.`;
    return;
  }
  if (decoded.hits) {
    const verdict = decoded.hits.verdict;
    for (let i = 0; i < pixelCount; ++i) if (verdict[i]) disagreeing.push(i);
    disagreeing.sort((i, j) => verdict[j] - verdict[i] || i - j);
    paintGround(layers.ground, decoded.pictures[0]);
  }
  element("loading").hidden = true;
  showBeyond();
  wire();
  refresh();
  document.documentElement.dataset.ready = "yes";
}
start();
