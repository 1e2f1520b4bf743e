// Unpacks the maps and triangles of the page, and keeps what the reader has chosen.
"use strict";
const gearcut = (() => {
  const description = JSON.parse(document.getElementById("viewer-description").textContent);
  const listeners = [];
  const chosen = { quantity: 0, flank: 0, place: null };

  async function unpack() {
    const text = atob(document.getElementById("viewer-block").textContent);
    const packed = Uint8Array.from(text, (letter) => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const bytes = await new Response(stream).arrayBuffer();
    if (bytes.byteLength !== description.bytes) throw new Error("the packed maps are not complete");
    return bytes;
  }

  // Colours of the two scales, 256 each: sequential, then diverging.
  const colours = (bytes) => new Uint8Array(bytes, description.colours, 2 * 256 * 3);

  // A quantity's values as numbers, NaN where there is none.
  function values(bytes, quantity) {
    const high = new Uint8Array(bytes, quantity.at, description.cells);
    const low = new Uint8Array(bytes, quantity.at + description.cells, description.cells);
    const step = (quantity.high - quantity.low) / 65534;
    return Float32Array.from(high, (byte, cell) => {
      const whole = byte * 256 + low[cell];
      return whole === 0 ? NaN : quantity.low + (whole - 1) * step;
    });
  }

  // Writes the colour of a value: three bytes at a place of an array.
  function paint(data, quantity, value, into, at) {
    if (Number.isNaN(value)) {
      into.fill(150, at, at + 3);
      return;
    }
    const [low, high] = quantity.scale;
    const share = high > low ? Math.min(1, Math.max(0, (value - low) / (high - low))) : 0.5;
    const from = 3 * (256 * quantity.colours + Math.round(255 * share));
    into[at] = data.colours[from];
    into[at + 1] = data.colours[from + 1];
    into[at + 2] = data.colours[from + 2];
  }

  function choose(change) {
    Object.assign(chosen, change);
    for (const listener of listeners) listener(chosen, change);
  }

  // Three significant digits and a real minus sign.
  function number(value) {
    if (value === 0 || !Number.isFinite(value)) return "0";
    const size = Math.abs(value);
    const plain = size >= 1e-4 && size < 1e6;
    const text = plain ? value.toFixed(Math.max(0, 2 - Math.floor(Math.log10(size)))) : value.toExponential(2);
    return text.replace("-", "−");
  }

  // Round values between two ends, at most so many.
  function ticks(low, high, most) {
    const rough = (high - low) / Math.max(1, most);
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= rough * 0.999);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    const found = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) {
      found.push([k * step, (k * step).toFixed(decimals).replace("-", "−").replace(/^−(0\.?0*)$/, "$1")]);
    }
    return found;
  }

  const flankName = (flank) => `tooth ${flank.tooth}, ${flank.side} flank`;

  const loaded = unpack().then((bytes) => {
    const data = { bytes, colours: colours(bytes), values: [] };
    data.valuesOf = (index) => (data.values[index] ??= values(bytes, description.quantities[index]));
    return data;
  });

  // What draws the gear, for the scripts that add to it; a browser without WebGL never gets there.
  let onStage;
  const stage = new Promise((resolve) => { onStage = resolve; });

  return {
    description, chosen, choose, loaded, paint, number, ticks, flankName, stage, onStage,
    onChoice: (listener) => listeners.push(listener),
  };
})();
