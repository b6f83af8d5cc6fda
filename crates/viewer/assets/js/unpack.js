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

/** Adds to each code its neighbour, which is whole already; arithmetic wraps by itself. */
function addNeighbours(codes, neighbour, width, pixels) {
  if (neighbour === "bin") {
    for (let i = pixels; i < codes.length; i++) codes[i] += codes[i - pixels];
  } else if (neighbour === "left") {
    for (let i = 0; i < codes.length; i++) if (i % width !== 0) codes[i] += codes[i - 1];
  }
}

/** Codes of one stream: Uint16Array, or Uint8Array for standard errors. */
async function unpackStream(entry, narrow, width, pixels) {
  const bytes = await inflate(takeBytes(entry.id));
  let codes = bytes;
  if (!narrow) {
    const count = bytes.length / 2;
    codes = new Uint16Array(count);
    for (let i = 0; i < count; i++) codes[i] = bytes[i] | (bytes[count + i] << 8);
  }
  addNeighbours(codes, entry.neighbour, width, pixels);
  return codes;
}

/** Codes of all channels of an array; [] if it has none. */
async function unpackChannels(entries, narrow, width, pixels) {
  const channels = await Promise.all(entries.map((e) => unpackStream(e, narrow, width, pixels)));
  entries.forEach((entry, channel) => {
    if (!entry.minus_green) return;
    const green = channels[1];
    const codes = channels[channel];
    for (let i = 0; i < codes.length; i++) codes[i] += green[i];
  });
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
