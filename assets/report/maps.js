// The picker, the map of the picked flank, the colour bar and the sheet of all flanks.
"use strict";
gearcut.loaded.then((data) => {
  const { description, chosen, choose, paint, number, ticks, flankName } = gearcut;
  const { flanks, quantities } = description;
  const by = (id) => document.getElementById(id);
  const [map, bar, sheet] = [by("map"), by("bar"), by("sheet")];
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const teeth = [...new Set(flanks.map((flank) => flank.tooth))];

  // Cells of a flank as a picture, u upwards: one pixel each.
  function picture(flank, quantity, values) {
    const { first, u, v } = flank.map;
    const image = new ImageData(v.count, u.count);
    for (let i = 0; i < u.count; i += 1) {
      for (let k = 0; k < v.count; k += 1) {
        const at = 4 * ((u.count - 1 - i) * v.count + k);
        paint(data, quantity, values[first + i * v.count + k], image.data, at);
        image.data[at + 3] = 255;
      }
    }
    const canvas = document.createElement("canvas");
    [canvas.width, canvas.height] = [v.count, u.count];
    canvas.getContext("2d").putImageData(image, 0, 0);
    return canvas;
  }

  // A canvas at the screen's own resolution, cleared; null while it is hidden.
  function fresh(canvas) {
    const { width, height } = canvas.getBoundingClientRect();
    if (width === 0) return null;
    const ratio = window.devicePixelRatio || 1;
    [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    const pen = canvas.getContext("2d");
    pen.scale(ratio, ratio);
    pen.font = `12px ${getComputedStyle(document.body).fontFamily}`;
    return { pen, width, height };
  }

  // Ends along u, mm, between which the chosen quantity is judged on a flank that has a map.
  const evaluated = (flank) => quantities[chosen.quantity].evaluated[flank.map.index];
  const edges = (axis) => [axis.start - axis.step / 2, axis.start + axis.step * (axis.count - 0.5)];
  const frame = { left: 40, right: 8, top: 6, bottom: 22 };
  let shown = null;

  function drawMap() {
    const surface = fresh(map);
    if (!surface) return;
    const { pen, width, height } = surface;
    const flank = flanks[chosen.flank];
    const quantity = quantities[chosen.quantity];
    by("map-title").textContent = `${quantity.name}: ${flankName(flank)}`;
    if (!flank.map) {
      shown = null;
      pen.fillStyle = css("--soft");
      pen.fillText("This flank was not cut: the run was stopped before.", frame.left, 30);
      return;
    }
    const values = data.valuesOf(chosen.quantity);
    const [u, v] = [edges(flank.map.u), edges(flank.map.v)];
    const [w, h] = [width - frame.left - frame.right, height - frame.top - frame.bottom];
    const box = { x: frame.left, y: frame.top, w, h };
    const x = (place) => box.x + ((place - v[0]) / (v[1] - v[0])) * box.w;
    const y = (place) => box.y + box.h - ((place - u[0]) / (u[1] - u[0])) * box.h;
    pen.imageSmoothingEnabled = false;
    pen.drawImage(picture(flank, quantity, values), box.x, box.y, box.w, box.h);
    pen.strokeStyle = css("--soft");
    pen.strokeRect(box.x, box.y, box.w, box.h);
    pen.fillStyle = css("--soft");
    pen.textAlign = "center";
    for (const [place, label] of ticks(v[0], v[1], box.w / 70)) {
      pen.fillRect(x(place), box.y + box.h, 1, 4);
      pen.fillText(label, x(place), box.y + box.h + 17);
    }
    pen.textAlign = "right";
    for (const [place, label] of ticks(u[0], u[1], box.h / 34)) {
      pen.fillRect(box.x - 4, y(place), 4, 1);
      pen.fillText(label, box.x - 8, y(place) + 4);
    }
    pen.save();
    pen.translate(11, box.y + box.h / 2);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = "center";
    pen.fillText("u [mm]", 0, 0);
    pen.restore();
    for (const end of evaluated(flank)) {
      if (end <= u[0] || end >= u[1]) continue;
      pen.setLineDash([6, 5]);
      pen.beginPath();
      pen.moveTo(box.x, y(end)); pen.lineTo(box.x + box.w, y(end));
      pen.strokeStyle = "#fff"; pen.lineWidth = 3; pen.stroke();
      pen.strokeStyle = "#111"; pen.lineWidth = 1; pen.stroke();
      pen.setLineDash([]);
    }
    shown = { box, u, v, flank, values };
    drawCross(pen, x, y);
  }

  function drawCross(pen, x, y) {
    const read = by("map-readout");
    const cell = chosen.place && cellAt(chosen.place);
    if (!cell) {
      read.textContent = "";
      return;
    }
    const [at, up] = [x(cell.v), y(cell.u)];
    for (const [colour, thick] of [["#fff", 4], ["#111", 1.5]]) {
      pen.strokeStyle = colour;
      pen.lineWidth = thick;
      pen.beginPath();
      pen.moveTo(at - 9, up); pen.lineTo(at + 9, up);
      pen.moveTo(at, up - 9); pen.lineTo(at, up + 9);
      pen.stroke();
    }
    pen.lineWidth = 1;
    const v = cell.v.toFixed(2).replace("-", "−");
    read.textContent = `${reading(cell.value)} at u ${cell.u.toFixed(2)} mm, v ${v} mm`;
  }

  const unit = () => quantities[chosen.quantity].unit;
  const reading = (value) => (Number.isNaN(value) ? "no value" : `${number(value)} ${unit()}`);

  // The cell of the shown map that holds a place (u, v) in mm.
  function cellAt([u, v]) {
    if (!shown) return null;
    const { first, u: up, v: along } = shown.flank.map;
    const index = (axis, place) => Math.min(axis.count - 1, Math.max(0, Math.round((place - axis.start) / axis.step)));
    const [i, k] = [index(up, u), index(along, v)];
    const value = shown.values[first + i * along.count + k];
    return { u: up.start + i * up.step, v: along.start + k * along.step, value };
  }

  function pointed(event) {
    if (!shown) return;
    const { left, top } = map.getBoundingClientRect();
    const { box, u, v } = shown;
    const across = (event.clientX - left - box.x) / box.w;
    const up = 1 - (event.clientY - top - box.y) / box.h;
    const inside = across >= 0 && across <= 1 && up >= 0 && up <= 1;
    if (inside) choose({ place: [u[0] + up * (u[1] - u[0]), v[0] + across * (v[1] - v[0])] });
  }

  function drawBar() {
    const surface = fresh(bar);
    if (!surface) return;
    const { pen, width } = surface;
    const quantity = quantities[chosen.quantity];
    const [low, high] = quantity.scale;
    const [inset, thick] = [14, 14];
    const colour = new Uint8ClampedArray(3);
    for (let pixel = inset; pixel < width - inset; pixel += 1) {
      paint(data, quantity, low + ((pixel - inset) / (width - 2 * inset)) * (high - low), colour, 0);
      pen.fillStyle = `rgb(${colour[0]} ${colour[1]} ${colour[2]})`;
      pen.fillRect(pixel, 4, 1, thick);
    }
    pen.fillStyle = css("--soft");
    pen.textAlign = "center";
    if (high > low) {
      for (const [value, label] of ticks(low, high, 5)) {
        const x = inset + ((value - low) / (high - low)) * (width - 2 * inset);
        pen.fillRect(x, 4 + thick, 1, 4);
        pen.fillText(label, x, 4 + thick + 17);
      }
    }
    // Points where values go beyond the colours.
    const triangle = (at, way) => {
      pen.beginPath();
      pen.moveTo(at, 4); pen.lineTo(at + way * 9, 4 + thick / 2); pen.lineTo(at, 4 + thick);
      pen.fill();
    };
    if (quantity.high > high) triangle(width - inset + 2, 1);
    if (quantity.low < low) triangle(inset - 2, -1);
    by("bar-name").textContent = `${quantity.name} [${quantity.unit}]`;
    by("quantity-definition").textContent = quantity.definition;
  }

  function drawNumbers() {
    const list = by("flank-numbers");
    list.replaceChildren();
    const flank = flanks[chosen.flank];
    if (!flank.map) return;
    const { first, u, v } = flank.map;
    const [from, to] = evaluated(flank);
    let [low, high, sum, count, below] = [Infinity, -Infinity, 0, 0, NaN];
    const values = data.valuesOf(chosen.quantity);
    for (let i = 0; i < u.count; i += 1) {
      const place = u.start + i * u.step;
      // Cells that reach over an end hold something of what lies beyond it.
      const inside = place - u.step / 2 >= from && place + u.step / 2 <= to;
      for (const value of values.subarray(first + i * v.count, first + (i + 1) * v.count)) {
        if (Number.isNaN(value)) continue;
        if (inside) [low, high, sum, count] = [Math.min(low, value), Math.max(high, value), sum + value, count + 1];
        else if (place < from && !(value < below)) below = value;
      }
    }
    const lines = [["evaluated, u", `${number(from)} to ${number(to)} mm`]];
    if (count) lines.push(["smallest", reading(low)], ["mean", reading(sum / count)], ["largest", reading(high)]);
    else lines.push(["values", "none"]);
    if (!Number.isNaN(below)) lines.push(["largest below the evaluated part", reading(below)]);
    for (const [name, words] of lines) {
      const [term, number_] = [document.createElement("dt"), document.createElement("dd")];
      term.textContent = name;
      number_.textContent = words;
      list.append(term, number_);
    }
  }

  // The sheet: one option per flank, painted anew when the quantity changes.
  const options = flanks.map((flank, index) => {
    const option = document.createElement("div");
    option.setAttribute("role", "option");
    option.setAttribute("aria-label", flankName(flank));
    option.append(`${flank.tooth} ${flank.side}`, document.createElement("canvas"));
    option.addEventListener("click", () => choose({ flank: index }));
    sheet.append(option);
    return option;
  });
  const longest = Math.max(...flanks.map((flank) => (flank.map ? flank.map.u.step * flank.map.u.count : 0)));

  function drawSheet() {
    const values = data.valuesOf(chosen.quantity);
    flanks.forEach((flank, index) => {
      const canvas = options[index].querySelector("canvas");
      const pen = canvas.getContext("2d");
      if (!flank.map) return;
      const cells = picture(flank, quantities[chosen.quantity], values);
      canvas.width = Math.min(160, cells.width);
      canvas.height = Math.max(1, Math.min(48, cells.height));
      canvas.style.height = `${(1.9 * flank.map.u.step * flank.map.u.count) / longest}rem`;
      pen.imageSmoothingEnabled = true;
      pen.drawImage(cells, 0, 0, canvas.width, canvas.height);
    });
  }

  function markSheet() {
    options.forEach((option, index) => {
      option.setAttribute("aria-selected", String(index === chosen.flank));
      option.tabIndex = index === chosen.flank ? 0 : -1;
    });
  }

  sheet.addEventListener("keydown", (event) => {
    const columns = getComputedStyle(sheet).gridTemplateColumns.split(" ").length;
    const step = { ArrowRight: 1, ArrowLeft: -1, ArrowDown: columns, ArrowUp: -columns }[event.key];
    if (!step) return;
    event.preventDefault();
    choose({ flank: Math.min(flanks.length - 1, Math.max(0, chosen.flank + step)) });
    options[chosen.flank].focus();
  });

  // The picker.
  quantities.forEach((quantity, index) => by("quantity").append(new Option(quantity.name, String(index))));
  const tooth = by("tooth");
  tooth.max = String(teeth.length);
  const sides = [...document.querySelectorAll('input[name="side"]')];
  const find = (number_, side) => flanks.findIndex((flank) => flank.tooth === number_ && flank.side === side);
  const pick = (number_, side) => {
    const index = find(((number_ - 1 + teeth.length) % teeth.length) + 1, side);
    if (index >= 0) choose({ flank: index });
  };
  const side = () => sides.find((radio) => radio.checked).value;
  by("quantity").addEventListener("change", (event) => choose({ quantity: Number(event.target.value) }));
  tooth.addEventListener("change", () => pick(Number(tooth.value) || 1, side()));
  by("tooth-before").addEventListener("click", () => pick(flanks[chosen.flank].tooth - 1, side()));
  by("tooth-after").addEventListener("click", () => pick(flanks[chosen.flank].tooth + 1, side()));
  for (const radio of sides) radio.addEventListener("change", () => pick(flanks[chosen.flank].tooth, radio.value));

  map.addEventListener("pointermove", pointed);
  map.addEventListener("pointerdown", pointed);
  map.addEventListener("keydown", (event) => {
    const step = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowRight: [0, 1], ArrowLeft: [0, -1] }[event.key];
    if (!step || !shown) return;
    event.preventDefault();
    const { u, v } = shown.flank.map;
    const [at, along] = chosen.place ?? [u.start + (u.step * u.count) / 2, v.start + (v.step * v.count) / 2];
    const cell = cellAt([at + step[0] * u.step, along + step[1] * v.step]);
    choose({ place: [cell.u, cell.v] });
  });

  // Places among the key numbers lead to their flank.
  for (const button of document.querySelectorAll("button.place")) {
    button.addEventListener("click", () => {
      const index = find(Number(button.dataset.tooth), button.dataset.side);
      if (index < 0) return;
      choose({ flank: index, place: [Number(button.dataset.u), Number(button.dataset.v)] });
      by("gear").scrollIntoView();
      by("gear-view").focus({ preventScroll: true });
    });
  }

  function redraw() {
    drawBar();
    drawMap();
    drawNumbers();
  }
  gearcut.onChoice((_, change) => {
    const flank = flanks[chosen.flank];
    tooth.value = String(flank.tooth);
    for (const radio of sides) radio.checked = radio.value === flank.side;
    by("quantity").value = String(chosen.quantity);
    if ("quantity" in change) drawSheet();
    markSheet();
    if ("quantity" in change || "flank" in change) redraw();
    else drawMap();
  });
  window.addEventListener("resize", redraw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
  window.addEventListener("beforeprint", redraw);
  choose({ quantity: 0, flank: 0 });
});
