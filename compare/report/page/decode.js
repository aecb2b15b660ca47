// ---- decode.js: from text to numbers. The counterpart of compare/report/encode.h.

const data = JSON.parse(document.getElementById("data").textContent);
const width = data.width, height = data.height, pixelCount = width * height;

async function inflate(base64) {
  const binary = atob(base64);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Undoes encode_plane: planes of bytes, the highest first, then running sums along each row.
async function decodePlane(text, bytes) {
  const planes = await inflate(text);
  const Numbers = { 1: Uint8Array, 2: Uint16Array, 4: Uint32Array }[bytes];
  const values = new Numbers(pixelCount);
  for (let i = 0; i < pixelCount; ++i) {
    let difference = 0;
    for (let b = 0; b < bytes; ++b) difference = difference * 256 + planes[b * pixelCount + i];
    values[i] = i % width === 0 ? difference : difference + values[i - 1];
  }
  return values;
}

// The value of every half-precision number, by its bits.
const halfValue = (() => {
  const table = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const exponent = (bits >> 10) & 31, fraction = bits & 1023;
    const size = exponent === 31 ? (fraction ? NaN : Infinity)
      : exponent === 0 ? fraction * 2 ** -24 : (1 + fraction / 1024) * 2 ** (exponent - 15);
    table[bits] = bits & 0x8000 ? -size : size;
  }
  return table;
})();

// A picture: three planes of half-precision bits.
class Picture {
  constructor(planes) { this.planes = planes; }
  value(i, channel) { return halfValue[this.planes[channel][i]]; }
  rgb(i) { return [0, 1, 2].map(channel => this.value(i, channel)); }
}

async function decodePicture(texts) {
  return new Picture(await Promise.all(texts.map(text => decodePlane(text, 2))));
}

async function decodeAll() {
  const [raster, raytrace, difference, object, primitive, objectChange, primitiveChange, verdict] = await Promise.all([
    decodePicture(data.raster), decodePicture(data.raytrace), decodePicture(data.difference),
    decodePlane(data.hits.object, 4), decodePlane(data.hits.primitive, 4),
    decodePlane(data.hits.object_change, 4), decodePlane(data.hits.primitive_change, 4),
    decodePlane(data.hits.verdict, 1)]);
  // Object 0 stands for none; what the path tracer saw is stored as the bits that differ.
  const hit = (i, change) => ({
    object: (object[i] ^ (change ? objectChange[i] : 0)) >>> 0,
    primitive: (primitive[i] ^ (change ? primitiveChange[i] : 0)) >>> 0 });
  return { raster, raytrace, difference, verdict, rasterHit: i => hit(i, false), raytraceHit: i => hit(i, true) };
}

const minus = text => String(text).replace("-", "−");

// A radiance in four significant digits or so.
function radianceText(v) {
  if (Number.isNaN(v)) return "NaN";
  if (!Number.isFinite(v)) return v > 0 ? "∞" : "−∞";
  const size = Math.abs(v);
  return minus(size === 0 ? "0" : size >= 1000 ? v.toFixed(0) : size >= 100 ? v.toFixed(1) : size >= 10 ? v.toFixed(2)
    : size >= 1 ? v.toFixed(3) : size >= 0.00005 ? v.toFixed(4) : v.toExponential(0));
}
const signedText = v => (v > 0 ? "+" : "") + radianceText(v);

function secondsText(s) {
  if (s < 0.0005) return `${(s * 1e6).toFixed(0)} µs`;
  if (s < 0.01) return `${(s * 1e3).toFixed(1)} ms`;
  if (s < 0.9995) return `${(s * 1e3).toFixed(0)} ms`;
  if (s < 59.95) return `${s.toFixed(s < 10 ? 2 : 1)} s`;
  const whole = Math.round(s);
  return whole < 3600 ? `${Math.floor(whole / 60)} min ${String(whole % 60).padStart(2, "0")} s`
    : `${Math.floor(whole / 3600)} h ${String(Math.floor(whole / 60) % 60).padStart(2, "0")} min`;
}
const countText = n => Number(n).toLocaleString("en").replaceAll(",", "\u2009");
