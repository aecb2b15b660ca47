// ---- metrics.js: builds the table of error metrics, each with an explanation.

// This table has the name and meaning of each metric's key, in the order of display. An unknown key is shown as it is.
// A key that starts with another key's name (flip_max) is listed below that one.
const metricTexts = {
  mse: ["MSE", "mean squared difference"],
  rmse: ["RMSE", "its root"],
  mae: ["MAE", "mean absolute difference"],
  psnr: ["PSNR", "peak signal to noise in dB; the peak is 1"],
  relmse: ["relMSE", "mean of squared difference / (reference² + 0.01)"],
  relmse_trimmed: ["relMSE, trimmed", "the same without the worst 0.1 % of the pixels"],
  smape: ["SMAPE", "mean of |difference| / (|A| + |B| + 0.01): 0 equal, 1 the most"],
  ssim: ["SSIM", "structural similarity: 1 equal, 0 unrelated"],
  flip: [
    data.flip.name,
    "mean over the pixels of how visible the difference is to someone who alternates between the images: 0 not at " +
        "all, 1 the most. Pixels below the weighted median make up half of the sum, those below the first quartile " +
        "a quarter" +
        (data.eight_bit ? "" :
                          "; each image is shown at several exposures, evenly spaced from the start to the stop " +
                          "exposure (in EV), and a pixel counts with its largest value")
  ],
  mean_signed_error: ["Mean signed error", `red, green, blue; positive: ${data.sides[0].name} is brighter`],
  worst: ["Worst pixel", "largest difference of a channel"],
  z_test: ["z-test", "p: how likely the images' noise alone would differ so; below 0.01 there is more than noise"],
  non_finite: ["Not finite", "pixels that are NaN or infinite and count nowhere"],
  nan: ["NaN", "pixels with a channel that is no number"],
  infinite: ["Infinite", "pixels with an infinite channel"],
};

const plainName = key => key.replaceAll("_", " ");

function row(name, explanation, value, options = {}) {
  return make("tr", options.bad ? { class: "bad" } : {},
    make("th", { scope: "row" }, ...(options.symbol ? [options.symbol] : []), name, make("small", {}, explanation)),
    make("td", { class: "number" }, value, ...[options.below || []].flat().map(line => make("small", {}, line))));
}

// Returns a link that shows a pixel on the stage.
function pixelLink([x, y], mode) {
  const link = make("a", { href: "#stage" }, `${x}, ${y}`);
  link.addEventListener("click", event => {
    event.preventDefault();
    setMode(mode);
    moveTo(x, y, 24);
    canvas.focus({ preventScroll: true });
    stage.scrollIntoView({ block: "center" });
  });
  return link;
}

// Formats any value as text: a number, three numbers per channel, or several named values.
function valueText(value, key) {
  if (typeof value === "number")
    return Number.isInteger(value) && Math.abs(value) > 1 ? countText(value) : figure(value);
  if (value === null) return key === "psnr" && data.metrics.mse === 0 ? "∞" : "none"; // JSON has no infinity
  if (Array.isArray(value)) return value.map(v => valueText(v)).join(", ");
  if (typeof value === "object")
    return Object.entries(value).map(([name, v]) => `${plainName(name)} ${valueText(v, name)}`).join(", ");
  return typeof value === "boolean" ? (value ? "yes" : "no") : String(value);
}

// Formats a value in large type and its details in small type: [value, …lines].
const metricCells = {
  mean_signed_error: value => [make(
      "span", {class: "lines"},
      ...value.map((v, c) => make("span", {}, `${"RGB"[c]} ${v === null ? "none" : (v > 0 ? "+" : "") + figure(v)}`)))],
  z_test: ({
    p,
    ...others
  }) => [`p = ${figure(p)}`, ...Object.entries(others).map(([name, v]) => `${plainName(name)} ${valueText(v)}`)],
  non_finite: countsOfSides,
  nan: countsOfSides,
  infinite: countsOfSides,
};
function countsOfSides(counts) {
  const sum = Object.values(counts).reduce((total, n) => total + n, 0);
  return [countText(sum), ...(sum > 0 ? [valueText(counts)] : [])];
}

function metricRow(key) {
  const value = data.metrics[key], [name, meaning] = metricTexts[key] || [plainName(key), ""];
  const [cell, ...below] = key in metricCells ? metricCells[key](value) : [valueText(value, key)];
  for (const part of partsOf(key))
    below.push(`${plainName(part.slice(key.length + 1))} ${valueText(data.metrics[part])}`);
  const bad = key === "non_finite" && cell !== "0";
  const explanation = key === "worst" && data.metrics.worst_pixel ?
      make("span", {}, `${meaning}, at `, pixelLink(data.metrics.worst_pixel, "difference")) :
      meaning;
  return row(name, explanation, cell, { bad, below });
}

const listed = key => key in metricTexts;
// Parts that are not in this list follow after it.
const partOrder = ["flip_min", "flip_first_quartile", "flip_weighted_median", "flip_third_quartile", "flip_max"];
const rank = part => partOrder.includes(part) ? partOrder.indexOf(part) : partOrder.length;
const partsOf = key => Object.keys(data.metrics)
                           .filter(part => part.startsWith(key + "_") && !listed(part) && part !== "worst_pixel")
                           .sort((a, b) => rank(a) - rank(b));
const hasRow = key => key === "nan" || key === "infinite" ? Object.values(data.metrics[key]).some(n => n > 0) : true;

function showMetrics() {
  fill("metrics-text", `${sides[0].name} (A) against ${sides[1].name} (B, the reference), `, data.eight_bit
    ? "8-bit files: relMSE, SMAPE and the mean signed error compare linear radiance, all else the stored values."
    : "over linear radiance.");
  const known = Object.keys(metricTexts).filter(key => key in data.metrics && hasRow(key));
  const parts = known.flatMap(partsOf),
        others = Object.keys(data.metrics)
                     .filter(
                         key => !listed(key) && !parts.includes(key) && key !== "worst_pixel" &&
                             (key !== "pixels" || data.metrics.pixels < pixelCount));
  fill("metrics-table", make("tbody", {}, ...[...known, ...others].map(metricRow)));
}
