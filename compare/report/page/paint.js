// ---- paint.js: converts values to colors.

// Encodes a value by the sRGB curve (IEC 61966-2-1) as a byte.
function encodeSrgb(v) {
  const x = Math.min(Math.max(v, 0), 1);
  return Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
}

// Returns the byte of every half-precision number at an exposure in stops. This table makes the exposure slider fast.
function exposureTable(stops) {
  const table = new Uint8Array(65536), gain = 2 ** stops;
  for (let bits = 0; bits < 65536; ++bits) table[bits] = encodeSrgb(halfValue[bits] * gain);
  return table;
}

// Returns the bytes of a color: the view transform (common/image/view_transform.h) at an exposure in stops. The curve
// of a tone is a table over the binary logarithm of its argument.
function displayedColor(rgb, stops) {
  if (!rgb.every(Number.isFinite)) return invalidColor;
  const { inset, outset, curve, log2_range: [low, high] } = data.tones[state.tone], gain = 2 ** stops;
  const times = (matrix, v) => matrix.map(row => row[0] * v[0] + row[1] * v[1] + row[2] * v[2]);
  const compressed = times(inset, rgb.map(v => Math.max(v, 0) * gain)).map(x => {
    const at = clamp((Math.log2(x) - low) / (high - low), 0, 1) * (curve.length - 1);
    const k = Math.min(Math.floor(at), curve.length - 2);
    return curve[k] + (curve[k + 1] - curve[k]) * (at - k);
  });
  return times(outset, compressed).map(encodeSrgb);
}

// Creates a canvas for an image. Its pixels are also read back, to choose text colors with enough contrast.
function newCanvas() {
  const canvas = make("canvas", { width, height });
  canvas.getContext("2d", { willReadFrequently: true });
  return canvas;
}

// Calls color(i, bytes, at) for every pixel to write its red, green and blue.
function paint(canvas, color) {
  const context = canvas.getContext("2d");
  const image = context.createImageData(width, height), bytes = image.data;
  for (let i = 0, at = 0; i < pixelCount; ++i, at += 4) {
    bytes[at + 3] = 255;
    color(i, bytes, at);
  }
  context.putImageData(image, 0, 0);
}

const invalidColor = [255, 0, 255]; // magenta, for NaN and infinity
const invalid = bits => (bits & 0x7c00) === 0x7c00;
function write(bytes, at, r, g, b) { bytes[at] = r; bytes[at + 1] = g; bytes[at + 2] = b; }

function paintImage(canvas, picture, stops) {
  if (state.tone !== "none") {
    paint(canvas, (i, bytes, at) => write(bytes, at, ...displayedColor(picture.rgb(i), stops)));
    return;
  }
  const table = exposureTable(stops), [r, g, b] = picture.planes;
  paint(canvas, (i, bytes, at) => {
    if (invalid(r[i]) || invalid(g[i]) || invalid(b[i])) write(bytes, at, ...invalidColor);
    else write(bytes, at, table[r[i]], table[g[i]], table[b[i]]);
  });
}

// Paints an image in pale gray, as a background for marks.
function paintGround(canvas, picture) {
  const table = exposureTable(0), [r, g, b] = picture.planes;
  paint(canvas, (i, bytes, at) => {
    const grey = 40 + 0.42 * (0.2126 * table[r[i]] + 0.7152 * table[g[i]] + 0.0722 * table[b[i]]);
    write(bytes, at, grey, grey, grey);
  });
}

// Paints gray over all pixels except those that are `lit`, so that these stand out whether they are dark or bright.
function paintDimming(canvas, lit) {
  paint(canvas, (i, bytes, at) => {
    write(bytes, at, 116, 116, 116);
    bytes[at + 3] = lit(i) ? 0 : 225;
  });
}

// These are the anchors of the false colors. "hue" uses the colors of compare/report/false_color.cpp for signed values
// and matplotlib's "magma" (Smith and van der Walt 2015), whose lightness increases evenly, for errors. "grey" uses no
// hues.
const palettes = {
  hue: {
    signed: [
      [8, 48, 107], [33, 102, 172], [82, 148, 206], [167, 205, 230], [246, 246, 244], [250, 203, 150], [233, 143, 53],
      [190, 92, 8], [115, 49, 6]
    ],
    error: [
      [0, 0, 4], [24, 15, 61], [68, 15, 118], [114, 31, 129], [158, 47, 127], [205, 64, 113], [241, 96, 93],
      [253, 150, 104], [254, 202, 141], [252, 253, 191]
    ],
  },
  grey: {
    signed: [
      [0, 0, 0], [38, 38, 38], [72, 72, 72], [100, 100, 100], [126, 126, 126], [155, 155, 155], [186, 186, 186],
      [220, 220, 220], [255, 255, 255]
    ],
    error: [[0, 0, 0], [255, 255, 255]],
  },
};

// Returns the color at a position in [0, 1] along the anchors.
function colorAt(anchors, position) {
  if (Number.isNaN(position)) return invalidColor;
  const at = clamp(position, 0, 1) * (anchors.length - 1);
  const low = Math.min(Math.floor(at), anchors.length - 2), f = at - low;
  return anchors[low].map((v, c) => Math.round(v + (anchors[low + 1][c] - v) * f));
}
const signedColor = value => colorAt(palettes[state.palette].signed, (value + 1) / 2); // for −1 to 1
const errorColor = value => colorAt(palettes[state.palette].error, value); // for 0 to 1
const css = color => `rgb(${color.join(" ")})`;

// Paints values between low and high. Returns how many are outside that range.
function paintValues(canvas, values, low, high, anchors) {
  const steps = 1024, table = [];
  for (let k = 0; k <= steps; ++k) table.push(colorAt(anchors, k / steps));
  let beyond = 0;
  paint(canvas, (i, bytes, at) => {
    const position = (values[i] - low) / (high - low);
    if (!Number.isFinite(position)) { write(bytes, at, ...invalidColor); return; }
    if (position < 0 || position > 1) ++beyond;
    write(bytes, at, ...table[Math.round(clamp(position, 0, 1) * steps)]);
  });
  return beyond;
}

const channels = { r: [1, 0, 0], g: [0, 1, 0], b: [0, 0, 1], luminance: [0.2126, 0.7152, 0.0722] };
const luminance = rgb => rgb.reduce((sum, v, c) => sum + v * channels.luminance[c], 0);

// Returns an image's value in one channel or in luminance, for every pixel.
function channelOf(picture, channel) {
  const result = new Float32Array(pixelCount), weights = channels[channel];
  for (let c = 0; c < 3; ++c) {
    if (weights[c] === 0) continue;
    const plane = picture.planes[c], weight = weights[c];
    for (let i = 0; i < pixelCount; ++i) result[i] += weight * halfValue[plane[i]];
  }
  return result;
}
