// ---- paint.js: from numbers to colours.

// The sRGB curve (IEC 61966-2-1), as a byte.
function encodeSrgb(v) {
  const x = Math.min(Math.max(v, 0), 1);
  return Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
}

// The byte of every half-precision number at an exposure in stops: one table look-up a channel makes the slider quick.
function exposureTable(stops) {
  const table = new Uint8Array(65536), gain = 2 ** stops;
  for (let bits = 0; bits < 65536; ++bits) table[bits] = encodeSrgb(halfValue[bits] * gain);
  return table;
}

function newCanvas() {
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  return canvas;
}

// Calls color(i, bytes, at) for every pixel, to write its red, green and blue.
function paint(canvas, color) {
  const context = canvas.getContext("2d");
  const image = context.createImageData(width, height), bytes = image.data;
  for (let i = 0, at = 0; i < pixelCount; ++i, at += 4) {
    color(i, bytes, at);
    bytes[at + 3] = 255;
  }
  context.putImageData(image, 0, 0);
}

const invalid = bits => (bits & 0x7c00) === 0x7c00; // NaN or infinite: shown in magenta
function write(bytes, at, r, g, b) { bytes[at] = r; bytes[at + 1] = g; bytes[at + 2] = b; }

function paintPicture(canvas, picture, stops) {
  const table = exposureTable(stops), [r, g, b] = picture.planes;
  paint(canvas, (i, bytes, at) => {
    if (invalid(r[i]) || invalid(g[i]) || invalid(b[i])) write(bytes, at, 255, 0, 255);
    else write(bytes, at, table[r[i]], table[g[i]], table[b[i]]);
  });
}

// The rasterizer's picture in pale grey: the ground for marks.
function paintGround(canvas, picture) {
  const table = exposureTable(0), [r, g, b] = picture.planes;
  paint(canvas, (i, bytes, at) => {
    const grey = 40 + 0.42 * (0.2126 * table[r[i]] + 0.7152 * table[g[i]] + 0.0722 * table[b[i]]);
    write(bytes, at, grey, grey, grey);
  });
}

// Anchors of the false colours, from −1 to 1; "hue" as in compare/report/false_color.cpp. "grey" tells the sign by lightness alone.
const anchors = {
  hue: [[8, 48, 107], [33, 102, 172], [82, 148, 206], [167, 205, 230], [246, 246, 244], [250, 203, 150], [233, 143, 53], [190, 92, 8], [115, 49, 6]],
  grey: [[0, 0, 0], [38, 38, 38], [72, 72, 72], [100, 100, 100], [126, 126, 126], [155, 155, 155], [186, 186, 186], [220, 220, 220], [255, 255, 255]],
};

function falseColor(palette, value) {
  const list = anchors[palette], position = (Math.min(Math.max(value, -1), 1) + 1) / 2 * (list.length - 1);
  const low = Math.min(Math.floor(position), list.length - 2), f = position - low;
  return list[low].map((v, c) => Math.round(v + (list[low + 1][c] - v) * f));
}

const channels = { r: [1, 0, 0], g: [0, 1, 0], b: [0, 0, 1], luminance: [0.2126, 0.7152, 0.0722] };

// a − b of every pixel in one channel or in luminance.
function differences(channel) {
  const result = new Float32Array(pixelCount), weights = channels[channel];
  for (let c = 0; c < 3; ++c) {
    if (weights[c] === 0) continue;
    const plane = decoded.difference.planes[c], weight = weights[c];
    for (let i = 0; i < pixelCount; ++i) result[i] += weight * halfValue[plane[i]];
  }
  return result;
}

// Paints the differences and returns the share of pixels beyond the range.
function paintDifference(canvas, values, range, palette) {
  const steps = 1024, table = [];
  for (let k = 0; k <= steps; ++k) table.push(falseColor(palette, k / steps * 2 - 1));
  let beyond = 0;
  paint(canvas, (i, bytes, at) => {
    const value = values[i] / range;
    if (!Number.isFinite(value)) { write(bytes, at, 255, 0, 255); return; }
    if (Math.abs(value) > 1) ++beyond;
    const color = table[Math.round((Math.min(Math.max(value, -1), 1) + 1) / 2 * steps)];
    write(bytes, at, color[0], color[1], color[2]);
  });
  return beyond / pixelCount;
}
