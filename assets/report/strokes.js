// The cutter over the gear, stroke by stroke, with what every stroke takes.
"use strict";
gearcut.stage.then(({ data, scene, geometry, metal, light, widen, draw }) => {
  const { strokes } = gearcut.description;
  if (!strokes) return;
  const [slider, play, facts] = ["strokes", "strokes-play", "stroke-facts"].map((id) => document.getElementById(id));
  const columns = new Float32Array(data.bytes, strokes.at, 7 * strokes.count);
  const of = (stroke) => Array.from({ length: 7 }, (_, column) => columns[column * strokes.count + stroke]);

  const material = new THREE.ShaderMaterial({
    side: THREE.DoubleSide,
    transparent: true,
    uniforms: { metal },
    vertexShader: `
      varying vec3 seen;
      void main() {
        vec4 standing = modelViewMatrix * vec4(position, 1.0);
        seen = standing.xyz;
        gl_Position = projectionMatrix * standing;
      }`,
    fragmentShader: `
      uniform vec3 metal; varying vec3 seen;
      void main() {
        vec3 facing = cross(dFdx(seen), dFdy(seen));
        ${light}
        gl_FragColor = vec4(metal * vec3(0.62, 0.78, 1.0) * (0.45 + 0.55 * light), 0.85);
      }`,
  });
  const cutter = new THREE.Mesh(geometry(strokes.cutter), material);
  cutter.visible = false;
  cutter.geometry.computeBoundingSphere();
  const reach = cutter.geometry.boundingSphere.radius;
  let shown = false;
  scene.add(cutter);

  // Operation and stroke of a stroke counted over all operations.
  function named(stroke) {
    let rest = stroke;
    for (const [name, count] of strokes.operations) {
      if (rest < count) return [name, rest, count];
      rest -= count;
    }
    return ["", rest, 0];
  }

  // Place 0 of the slider is the finished gear alone; the others are the strokes, of very many every second, third ...
  function show() {
    const place = Number(slider.value);
    cutter.visible = place > 0;
    if (place === 0) {
      facts.textContent = "The finished gear; move to follow the cutter stroke by stroke";
      return draw();
    }
    const stroke = place - 1;
    const [x, y, angle, section, thickness, force, space] = of(stroke);
    if (!shown) widen(0.75 * (Math.hypot(x, y) + reach));
    shown = true;
    cutter.position.set(x, y, 0);
    cutter.rotation.z = angle;
    const [name, own, count] = named(stroke * strokes.every);
    const sizes = `chip ${gearcut.number(section)} mm², ${gearcut.number(thickness)} µm thick`;
    const taken = space === 0 ? "takes nothing" : `${sizes}, ${Math.round(force)} N, space ${space}`;
    facts.textContent = `${name}: stroke ${own} of ${count - 1}, ${taken}`;
    draw();
  }

  let playing = null;
  const stop = () => {
    clearInterval(playing);
    playing = null;
    play.setAttribute("aria-pressed", "false");
    play.textContent = "Play";
  };
  slider.max = strokes.count;
  slider.addEventListener("input", () => { stop(); show(); });
  play.addEventListener("click", () => {
    if (playing) return stop();
    play.setAttribute("aria-pressed", "true");
    play.textContent = "Stop";
    // All strokes in about forty seconds.
    const step = Math.max(1, Math.round(strokes.count / 600));
    playing = setInterval(() => {
      const next = Number(slider.value) + step;
      slider.value = next > strokes.count ? 0 : next;
      show();
    }, 66);
  });
  show();
});
