// What stands over the gear: numbers of the teeth, a scale, the axes of the gear frame.
"use strict";
gearcut.stage.then(({ camera, controls, canvas, flankShape, cut, overlays, draw }) => {
  const { flanks } = gearcut.description;
  const sheet = document.getElementById("gear-marks");
  const pen = sheet.getContext("2d");
  const toggle = document.getElementById("tooth-numbers");

  // Where the number of a tooth stands: between its flanks, a little outside them, at both ends.
  const position = flankShape.getAttribute("position");
  const teeth = new Map();
  for (const { tooth, corners: [first, count] } of flanks) {
    const sum = teeth.get(tooth) ?? { middle: new THREE.Vector3(), count: 0, low: Infinity, high: -Infinity };
    for (let corner = first; corner < first + count; corner += 1) {
      const at = new THREE.Vector3().fromBufferAttribute(position, corner);
      sum.middle.add(at);
      [sum.low, sum.high] = [Math.min(sum.low, at.z), Math.max(sum.high, at.z)];
    }
    sum.count += count;
    teeth.set(tooth, sum);
  }
  const anchors = [...teeth].map(([tooth, { middle, count, low, high }]) => {
    middle.divideScalar(count);
    return { tooth, ends: [low, high].map((z) => new THREE.Vector3(middle.x, middle.y, z)) };
  });

  function onSheet(at) {
    const seen = at.clone().project(camera);
    return [((seen.x + 1) / 2) * sheet.clientWidth, ((1 - seen.y) / 2) * sheet.clientHeight];
  }

  // Every number that has room: every first, second, fifth, tenth ...
  function numbers() {
    const end = camera.position.z >= controls.target.z ? 1 : 0;
    // On a section across the axis they stand on the section.
    const across = (at) => (cut.value.z === 0 ? at : at.clone().setZ(0));
    const standing = anchors.map(({ tooth, ends }) => [tooth, across(ends[end])]);
    const left = standing.filter(([, at]) => at.dot(cut.value) <= 1e-6);
    const places = left.map(([tooth, at]) => [tooth, ...onSheet(at)]);
    const gaps = places.slice(1).map(([, x, y], i) => Math.hypot(x - places[i][1], y - places[i][2]));
    gaps.sort((a, b) => a - b);
    const usual = gaps[Math.floor(gaps.length / 2)] || 100;
    const every = [1, 2, 5, 10, 20, 50, 100, 1000].find((step) => step * usual > 20);
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    for (const [tooth, x, y] of places) {
      if (tooth === 1 || tooth % every === 0) haloed(String(tooth), x, y);
    }
  }

  function haloed(words, x, y) {
    pen.lineWidth = 3.5;
    pen.lineJoin = "round";
    pen.strokeText(words, x, y);
    pen.fillText(words, x, y);
  }

  // A round length as it looks at the middle of the view.
  function scale() {
    const distance = camera.position.distanceTo(controls.target);
    const pixel = (2 * distance * Math.tan((Math.PI / 360) * camera.fov)) / sheet.clientHeight;
    const most = Math.min(120, sheet.clientWidth / 4) * pixel;
    const power = 10 ** Math.floor(Math.log10(most));
    const length = [5, 2, 1].map((factor) => factor * power).find((candidate) => candidate <= most);
    const [right, y] = [sheet.clientWidth - 14, sheet.clientHeight - 14];
    const left = right - length / pixel;
    pen.beginPath();
    pen.moveTo(left, y - 5);
    pen.lineTo(left, y);
    pen.lineTo(right, y);
    pen.lineTo(right, y - 5);
    pen.lineWidth = 1.5;
    pen.save();
    pen.strokeStyle = pen.fillStyle;
    pen.stroke();
    pen.restore();
    pen.textAlign = "center";
    pen.textBaseline = "bottom";
    haloed(`${length} mm`, (left + right) / 2, y - 4);
  }

  function axes() {
    const [x, y] = [36, sheet.clientHeight - 36];
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    for (const [name, direction] of [["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]]) {
      const seen = new THREE.Vector3(...direction).transformDirection(camera.matrixWorldInverse);
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(x + 20 * seen.x, y - 20 * seen.y);
      pen.lineWidth = 1.5;
      pen.save();
      pen.strokeStyle = pen.fillStyle;
      pen.stroke();
      pen.restore();
      haloed(name, x + 28 * seen.x, y - 28 * seen.y);
    }
  }

  overlays.push(() => {
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (width === 0 || height === 0) return;
    if (sheet.width !== Math.round(width * ratio) || sheet.height !== Math.round(height * ratio)) {
      [sheet.width, sheet.height] = [width * ratio, height * ratio].map(Math.round);
    }
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    const style = getComputedStyle(document.documentElement);
    pen.font = "12px " + getComputedStyle(document.body).fontFamily;
    pen.fillStyle = style.getPropertyValue("--ink").trim();
    pen.strokeStyle = style.getPropertyValue("--paper").trim();
    if (toggle.getAttribute("aria-pressed") === "true") numbers();
    scale();
    axes();
  });
  toggle.addEventListener("click", () => {
    toggle.setAttribute("aria-pressed", String(toggle.getAttribute("aria-pressed") !== "true"));
    draw();
  });
  draw();
});
