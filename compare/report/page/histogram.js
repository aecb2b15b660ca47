// ---- histogram.js: draws a histogram of pixel errors. A selected bin highlights its pixels on the stage.

// Returns a round number (1, 2 or 5 times a power of ten) that is at least v.
function roundUp(v) {
  const power = 10 ** Math.floor(Math.log10(v));
  return [1, 2, 5, 10].find(step => step * power >= v * (1 - 1e-9)) * power;
}

// Returns evenly spaced bin edges. Values beyond the first and last edge belong to the first and last bin.
const evenly = (low, high, bins) => Array.from({ length: bins + 1 }, (_, k) => low + (high - low) * k / bins);

// Returns the differences of luminance over √(reference² + 0.01). Their mean square is a relMSE.
function relativeDifferences() {
  const difference = channelOf(decoded.difference, "luminance"),
        reference = channelOf(decoded.pictures[1], "luminance");
  return difference.map((d, i) => d / Math.sqrt(reference[i] ** 2 + 0.01));
}

function quantile(values, share) {
  const sorted = values.filter(Number.isFinite).map(Math.abs).sort();
  return sorted.length ? sorted[Math.floor((sorted.length - 1) * share)] : 0;
}

// Each quantity of the histogram has the values of all pixels, the bin edges, the tick values, and the color of a
// value.
const quantities = {
  signed: {
    title: "signed relative difference",
    text:
        "(A − B) / √(B² + 0.01) of luminance: left of the middle A is darker, right of it brighter. The outermost " +
        "bins hold all that lies beyond.",
    values: relativeDifferences,
    edges: values => {
      const range = roundUp(Math.max(quantile(values, 0.995), 1e-3));
      return evenly(-range, range, 61);
    },
    ticks: edges => [-1, -0.5, 0, 0.5, 1].map(f => f * edges[edges.length - 1]),
    color: (v, edges) => signedColor(v / edges[edges.length - 1]),
  },
  absolute: {
    title: "size of the difference",
    text:
        "|A − B| of luminance, each bin 1.58 times the one before it (five a decade). The first holds all smaller " +
        "ones, 0 too.",
    values: () => channelOf(decoded.difference, "luminance").map(Math.abs),
    edges: values => {
      const decades = Math.ceil(Math.log10(Math.max(quantile(values, 1), 1e-3)) + 5);
      return Array.from({ length: 5 * decades + 1 }, (_, k) => 10 ** (k / 5 - 5));
    },
    ticks: edges => edges.filter((_, k) => k % 5 === 0),
    color: () => null,
  },
  flip: {
    title: data.flip.name,
    text: `${data.flip.name}, in steps of 0.025: left what nobody sees, right what everybody does.`,
    values: () => decoded.flip,
    edges: () => evenly(0, 1, 40),
    ticks: () => [0, 0.25, 0.5, 0.75, 1],
    color: v => errorColor(v),
  },
};

let histogram = null; // for state.histogram: { quantity, edges, counts, binOf (255: not finite), values, finite }

function countBins() {
  const quantity = quantities[state.histogram], values = quantity.values(), edges = quantity.edges(values);
  const bins = edges.length - 1, counts = new Array(bins).fill(0), binOf = new Uint8Array(pixelCount).fill(255);
  let finite = 0;
  for (let i = 0; i < pixelCount; ++i) {
    if (!Number.isFinite(values[i])) continue;
    let low = 0, high = bins - 1; // finds the last bin whose lower edge is not above the value
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (edges[middle] <= values[i]) low = middle; else high = middle - 1;
    }
    ++counts[low];
    ++finite;
    binOf[i] = low;
  }
  histogram = { quantity, edges, counts, binOf, values, finite };
}

// Returns the position of a value, in bins from the left.
function positionOf(v) {
  const { edges } = histogram, k = edges.findIndex(edge => edge > v);
  return k < 0 ? edges.length - 1 : k === 0 ? 0 : k - 1 + (v - edges[k - 1]) / (edges[k] - edges[k - 1]);
}

function binRange(k) {
  const { edges, counts } = histogram, text = v => (state.histogram === "signed" && v > 0 ? "+" : "") + roundText(v);
  if (k === 0 && state.histogram !== "flip") return `below ${text(edges[1])}`;
  return k === counts.length - 1 && state.histogram === "signed" ? `${text(edges[k])} and above` :
                                                                   `${text(edges[k])} to ${text(edges[k + 1])}`;
}

function binText(k) {
  const n = histogram.counts[k];
  return `${histogram.quantity.title} ${binRange(k)}: ${countText(n)} ${n === 1 ? "pixel" : "pixels"}, ${
      percentText(n / pixelCount)}`;
}

// Draws bars on a logarithmic scale from 1/2 (an empty bin has no bar) to the next power of ten.
function showHistogram() {
  const { edges, counts, quantity, finite } = histogram, bins = counts.length;
  const top = 10 ** Math.ceil(Math.log10(Math.max(...counts, 2))),
        heightOf = n => n > 0 ? Math.log(2 * n) / Math.log(2 * top) * 100 : 0;
  element("quantity").value = state.histogram;
  fill(
      "histogram-text", quantity.text,
      finite < pixelCount ? ` ${countText(pixelCount - finite)} pixels are not finite and not counted.` : "");
  fill("bins", ...counts.map((n, k) => {
    const color = quantity.color((edges[k] + edges[k + 1]) / 2, edges);
    return make(
        "div", {class: "bin", "data-count": n},
        make("i", {style: `height:${heightOf(n).toFixed(2)}%${color ? `;background:${css(color)}` : ""}`}));
  }));
  const lines = [];
  for (let n = 1; n <= top; n *= 10)
    lines.push(make(
        "span", {style: `bottom:${heightOf(n).toFixed(2)}%`},
        n < 1000 ? String(n) : powerText(Math.round(Math.log10(n)))));
  fill("count-lines", ...lines);
  fill(
      "bin-ticks",
      ...quantity.ticks(edges).map(v => make("span", {style: `left:${100 * positionOf(v) / bins}%`}, roundText(v))));
  fill(
      "bin-rows",
      ...counts.map(
          (n, k) =>
              make("tr", {}, make("th", {scope: "row"}, binRange(k)), make("td", {class: "number"}, countText(n)))));
  showBin();
}

// Shows the selected bin in the chart, as text and on the stage.
function showBin() {
  if (state.bin >= histogram.counts.length) state.bin = -1;
  const bars = element("bins"), k = state.bin;
  [...bars.children].forEach((bar, at) => bar.classList.toggle("chosen", at === k));
  bars.setAttribute("aria-valuemax", histogram.counts.length - 1);
  bars.setAttribute("aria-valuenow", Math.max(k, 0));
  const text = k < 0 ? "No bin is chosen" : binText(k);
  bars.setAttribute("aria-valuetext", text);
  element("bin-text").textContent =
      k < 0 ? "Point at a bar for its numbers; choose one (click, tap or arrow keys) to see its pixels." : text;
  lit = [];
  if (k >= 0) {
    for (let i = 0; i < pixelCount; ++i) if (histogram.binOf[i] === k) lit.push(i);
    lit.sort((i, j) => Math.abs(histogram.values[j]) - Math.abs(histogram.values[i]) || i - j);
    paintDimming(layers.veil, i => histogram.binOf[i] === k);
  }
  showSteps();
  redraw();
}

function chooseBin(k) {
  state.bin = k;
  showBin();
  writeAddress();
}

function setQuantity(key) {
  state.histogram = key;
  state.bin = -1;
  countBins();
  showHistogram();
  writeAddress();
}

function wireHistogram() {
  fill(
      "quantity", ...Object.entries(quantities).map(([key, quantity]) => make("option", {value: key}, quantity.title)));
  element("quantity").addEventListener("change", event => setQuantity(event.target.value));
  const bars = element("bins");
  const binAt = event => {
    const box = bars.getBoundingClientRect();
    return clamp(
        Math.floor((event.clientX - box.left) / box.width * histogram.counts.length), 0, histogram.counts.length - 1);
  };
  bars.addEventListener("pointermove", event => { element("bin-text").textContent = binText(binAt(event)); });
  bars.addEventListener("pointerleave", () => {
    if (histogram) element("bin-text").textContent = state.bin < 0 ? "" : binText(state.bin);
  });
  bars.addEventListener("click", event => { const k = binAt(event); chooseBin(k === state.bin ? -1 : k); });
  bars.addEventListener("keydown", event => {
    const last = histogram.counts.length - 1, from = state.bin < 0 ? -1 : state.bin;
    const to = {
      ArrowLeft: Math.max(from - 1, 0),
      ArrowDown: Math.max(from - 1, 0),
      ArrowRight: Math.min(from + 1, last),
      ArrowUp: Math.min(from + 1, last),
      Home: 0,
      End: last,
      Escape: -1
    }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    chooseBin(to);
  });
}
