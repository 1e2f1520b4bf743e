// Maps of numbers as colours, and the scales that say which colour is which number.

const EMPTY = [150, 150, 150];

// Range of most finite numbers: a few outliers, such as places that no stroke reached, do not take the colours.
export function rangeOf(arrays) {
  const sample = [];
  for (const of of arrays) {
    const every = Math.max(1, Math.floor(of.length * arrays.length / 20_000));
    for (let i = 0; i < of.length; i += every) if (Number.isFinite(of[i])) sample.push(of[i]);
  }
  if (sample.length === 0) return null;
  sample.sort((a, b) => a - b);
  const at = (share) => sample[Math.round(share * (sample.length - 1))];
  let [low, high] = [at(0.01), at(0.99)];
  const limit = Math.max(Math.abs(low), Math.abs(high)) || 1e-6;
  const diverges = low < -0.01 * limit;
  if (diverges) [low, high] = [-limit, limit];
  if (high - low < 1e-9) [low, high] = [low - 1e-6, high + 1e-6];
  return { low, high, diverges };
}

// Paints numbers into a canvas: `width` by `height` cells, `at(x, y)` the number of a cell, the first row at the top.
export function paint(canvas, [width, height], at, range, colours) {
  [canvas.width, canvas.height] = [width, height];
  const pen = canvas.getContext("2d");
  const image = pen.createImageData(width, height);
  const from = range.diverges ? 768 : 0;
  const factor = 255 / (range.high - range.low);
  let to = 0;
  for (let y = 0; y < height; y += 1) {
    for (let x = 0; x < width; x += 1, to += 4) {
      const value = at(x, y);
      const place = Math.min(255, Math.max(0, Math.round((value - range.low) * factor)));
      const cell = Number.isNaN(value) ? EMPTY : colours.subarray(from + 3 * place, from + 3 * place + 3);
      image.data.set(cell, to);
      image.data[to + 3] = Number.isNaN(value) ? 0 : 255;
    }
  }
  pen.putImageData(image, 0, 0);
}

// Three significant digits and a real minus sign.
export function number(value) {
  if (value === null || !Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  if (size < 1e-6) return "0";
  const digits = Math.min(6, Math.max(0, 2 - Math.floor(Math.log10(size))));
  return value.toFixed(digits).replace("-", "−");
}

// A bar of all colours with round numbers below.
export function drawScale(canvas, range, unit, factor, colours) {
  const [ratio, style] = [Math.min(2, devicePixelRatio), getComputedStyle(canvas)];
  [canvas.width, canvas.height] = [canvas.clientWidth * ratio, canvas.clientHeight * ratio];
  const pen = canvas.getContext("2d");
  pen.scale(ratio, ratio);
  const [left, width] = [8, canvas.clientWidth - 16];
  const from = range.diverges ? 768 : 0;
  for (let x = 0; x < width; x += 1) {
    const place = from + 3 * Math.round(255 * x / width);
    pen.fillStyle = `rgb(${colours.subarray(place, place + 3).join(" ")})`;
    pen.fillRect(left + x, 2, 1.5, 12);
  }
  pen.fillStyle = style.getPropertyValue("--ink");
  pen.font = `12px ${style.fontFamily}`;
  const [low, high] = [range.low * factor, range.high * factor];
  const rough = (high - low) / 5;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((of) => of * power).find((of) => of >= rough * 0.999);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const first = Math.ceil(low / step - 1e-9);
  for (let k = first; k * step <= high + 1e-9 * step; k += 1) {
    const x = left + width * (k * step - low) / (high - low);
    const last = (k + 1) * step > high + 1e-9 * step;
    const words = (k * step).toFixed(decimals).replace("-", "−") + (last ? ` ${unit}` : "");
    pen.textAlign = x > left + width - 40 ? "right" : x < left + 20 ? "left" : "center";
    pen.fillText(words, pen.textAlign === "right" ? left + width : x, 30);
    pen.fillRect(x, 14, 1, 4);
  }
}
