// ---- decode.js: decodes images from text, the inverse of compare/report/encode.h.

const width = data.width, height = data.height, pixelCount = width * height;

async function inflate(base64) {
  const binary = atob(base64);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Inverts encode_plane: joins byte planes, the highest first, then computes running sums along each row.
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

// This table holds the value of every half-precision number, indexed by its bits.
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

// The largest half-precision number stands for all values that are larger.
const largestHalf = 65504;
const isBeyond = v => Math.abs(v) >= largestHalf && Number.isFinite(v);
const pixelText = v => isBeyond(v) ? (v > 0 ? `≥ ${largestHalf}` : `≤ −${largestHalf}`) : radianceText(v);
const signedPixelText = v => isBeyond(v) ? pixelText(v) : signedText(v);

// Holds an image as three planes of half-precision bits.
class Picture {
  constructor(planes) { this.planes = planes; }
  value(i, channel) { return halfValue[this.planes[channel][i]]; }
  isBeyond(i) { return this.planes.some(plane => (plane[i] & 0x7fff) === 0x7bff); } // for any channel
  rgb(i) { return [0, 1, 2].map(channel => this.value(i, channel)); }
}

async function decodeImage(texts) {
  return new Picture(await Promise.all(texts.map(text => decodePlane(text, 2))));
}

// Decodes the object and primitive that each side hit, and the verdicts. Object 0 is a miss. B's hits are
// stored as the exclusive or with A's.
async function decodeHits(hits) {
  const [object, primitive, objectChange, primitiveChange, verdict] = await Promise.all([
    decodePlane(hits.object, 4), decodePlane(hits.primitive, 4),
    decodePlane(hits.object_change, 4), decodePlane(hits.primitive_change, 4), decodePlane(hits.verdict, 1)]);
  return {
    verdict,
    of: [i => ({ object: object[i], primitive: primitive[i] }),
      i => ({ object: (object[i] ^ objectChange[i]) >>> 0, primitive: (primitive[i] ^ primitiveChange[i]) >>> 0 })] };
}

// Decodes FLIP errors from steps of 1/4095. Code 4096 is NaN.
async function decodeFlip(flip) {
  return Float32Array.from(await decodePlane(flip.map, 2), code => code > 4095 ? NaN : code / 4095);
}

async function decodeAll() {
  const [a, b, difference, hits, flip] = await Promise.all([
    decodeImage(data.sides[0].picture), decodeImage(data.sides[1].picture), decodeImage(data.difference),
    data.hits && decodeHits(data.hits), decodeFlip(data.flip)]);
  return { pictures: [a, b], difference, hits, flip };
}
