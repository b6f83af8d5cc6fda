// From the page's data elements to codes, and from codes to numbers.
// The counterpart of the Rust module `tpb_viewer::pack`, which defines the format.

/** Bytes of a base64 data element, which is emptied: its text is not needed twice. */
function takeBytes(id) {
  const element = document.getElementById(id);
  const text = element.textContent;
  element.textContent = "";
  if (typeof Uint8Array.fromBase64 === "function") return Uint8Array.fromBase64(text);
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

/** Inflates a raw deflate stream (RFC 1951). */
async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Symbols of one stream: Uint16Array, or Uint8Array for standard errors. */
async function inflateSymbols(id, narrow) {
  const bytes = await inflate(takeBytes(id));
  if (narrow) return bytes;
  const count = bytes.length / 2;
  const symbols = new Uint16Array(count);
  for (let i = 0; i < count; i++) symbols[i] = bytes[i] | (bytes[count + i] << 8);
  return symbols;
}

/**
 * Turns symbols into codes, in place. Symbol 0 is code 0; other symbols tell the difference to a
 * prediction: the mean of neighbours that are not 0, or else the last code that was not 0.
 */
function restoreCodes(codes, neighbours, green, width, pixels) {
  const largest = codes.BYTES_PER_ELEMENT === 1 ? 255 : 65535;
  const useLeft = neighbours === "left" || neighbours === "mean";
  const useAbove = neighbours === "mean";
  const useBin = neighbours === "bin" || neighbours === "mean";
  let last = 0;
  for (let i = 0; i < codes.length; i++) {
    if (codes[i] === 0) continue;
    let sum = 0;
    let count = 0;
    const add = (from) => {
      if (codes[from] === 0) return;
      sum += codes[from] - (green ? green[from] : 0);
      count++;
    };
    if (useLeft && i % width !== 0) add(i - 1);
    if (useAbove && i % pixels >= width) add(i - width);
    if (useBin && i >= pixels) add(i - pixels);
    const base = green ? green[i] : 0;
    const predicted = base + (count > 0 ? Math.trunc(sum / count) : last);
    const zigzag = codes[i] - 1;
    const difference = (zigzag >> 1) ^ -(zigzag & 1);
    const code = (predicted + difference - 1) % largest;
    codes[i] = 1 + (code < 0 ? code + largest : code);
    last = codes[i] - base;
  }
}

/** Codes of all channels of an array; [] if it has none. */
async function unpackChannels(entries, narrow, width, pixels) {
  const channels = await Promise.all(entries.map((entry) => inflateSymbols(entry.id, narrow)));
  const restore = (channel) => {
    const { neighbours, minus_green: minusGreen } = entries[channel];
    restoreCodes(channels[channel], neighbours, minusGreen ? channels[1] : null, width, pixels);
  };
  // Green first: the others may be told from it.
  const order = channels.length === 3 ? [1, 0, 2] : [...channels.keys()];
  order.forEach(restore);
  return channels;
}

/** Values of all 16-bit codes: 0, positive, not finite (2^15), negative. */
function valueTable(steps, offset) {
  const table = new Float64Array(65536);
  for (let code = 1; code < 32768; code++) {
    const value = 2 ** ((code - 1) / steps - offset);
    table[code] = value;
    table[code + 32768] = -value;
  }
  table[32768] = NaN;
  return table;
}

/** Standard errors of all 8-bit codes, relative to their cell; NaN where unknown. */
function errorTable(steps, offset) {
  const table = new Float64Array(256);
  for (let code = 1; code < 255; code++) table[code] = 2 ** ((code - 1) / steps - offset);
  table[255] = NaN;
  return table;
}
