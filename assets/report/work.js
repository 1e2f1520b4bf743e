// The work as the strokes so far have left it, in slabs along the axis: between nodes of which one is still material
// and the other is gone, the surface is where the page's edges say.
"use strict";
gearcut.stage.then(({ data, scene, finished, bodyMaterial, edgeMaterial, edges }) => {
  const work = gearcut.description.strokes?.work;
  if (!work) return;
  const [columns, rows] = work.counts;
  const nodes = columns * rows;
  const spread = 0.1 * work.step;
  const slabs = work.slabs.map(({ z, at }) => {
    const part = (index) => new Uint8Array(data.bytes, at + index * nodes, nodes);
    const [high, low, alongX, alongY] = [0, 1, 2, 3].map(part);
    const gone = Uint16Array.from(high, (byte, node) => 256 * byte + low[node]);
    return { z, gone, alongX, alongY, cells: new Uint8Array(nodes) };
  });

  // Corners with normals, three values each, that grow as they must.
  const buffer = (drawn) => ({ drawn, at: new Float32Array(3e5), normals: new Float32Array(3e5), used: 0 });
  function corner(into, x, y, z, normal) {
    if (into.used === into.at.length) {
      for (const name of ["at", "normals"]) {
        const wider = new Float32Array(2 * into.used);
        wider.set(into[name]);
        into[name] = wider;
      }
    }
    const { at, normals, used } = into;
    [at[used], at[used + 1], at[used + 2]] = [x, y, z];
    [normals[used], normals[used + 1], normals[used + 2]] = normal;
    into.used += 3;
  }
  function send({ drawn, at, normals, used }) {
    const shape = drawn.geometry;
    if (shape.getAttribute("position")?.array !== at) {
      drawn.geometry.dispose();
      drawn.geometry = new THREE.BufferGeometry();
      drawn.geometry.setAttribute("position", new THREE.BufferAttribute(at, 3));
      drawn.geometry.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
    }
    for (const name of ["position", "normal"]) {
      const attribute = drawn.geometry.getAttribute(name);
      attribute.clearUpdateRanges();
      attribute.addUpdateRange(0, used);
      attribute.needsUpdate = true;
    }
    drawn.geometry.setDrawRange(0, used / 3);
  }
  const body = buffer(new THREE.Mesh(new THREE.BufferGeometry(), bodyMaterial));
  const outline = buffer(new THREE.LineSegments(new THREE.BufferGeometry(), edgeMaterial));
  edges.push(outline.drawn);
  // A scene within the scene: it is shown or not; what a section does to the lines does not matter.
  const shown = new THREE.Scene();
  for (const { drawn } of [body, outline]) {
    drawn.frustumCulled = false;
    shown.add(drawn);
  }
  shown.visible = false;
  scene.add(shown);

  // Which corners of every cell are material: one bit each, counter-clockwise.
  const FULL = 15;
  function mark({ gone, cells }, place) {
    for (let row = 0; row + 1 < rows; row += 1) {
      let left = 0;
      for (let column = 0, node = row * columns; column < columns; column += 1, node += 1) {
        const right = (gone[node] > place ? 1 : 0) | (gone[node + columns] > place ? 2 : 0);
        if (column > 0) cells[node - 1] = (left & 1) | ((right & 1) << 1) | ((right & 2) << 1) | ((left & 2) << 2);
        left = right;
      }
      cells[row * columns + columns - 1] = 0;
    }
  }

  const UP = [0, 0, 1];
  const DOWN = [0, 0, -1];
  const placed = (column, row) => [work.corner[0] + work.step * column, work.corner[1] + work.step * row];

  // Walls bend where they meet: each end has the mean normal of both, summed by edges of the grid, two for each node.
  const normals = new Float32Array(4 * nodes);
  const bends = [];
  function wall([p, first], [q, second]) {
    for (const edge of [first, second]) {
      normals[2 * edge] += q[1] - p[1];
      normals[2 * edge + 1] += p[0] - q[0];
    }
    bends.push([[p, first], [q, second]]);
  }
  function normalAt(edge) {
    const [x, y] = [normals[2 * edge], normals[2 * edge + 1]];
    const length = Math.hypot(x, y) || 1;
    return [x / length, y / length, 0];
  }

  // The part of a cell that is material, counter-clockwise; its sides inside the cell are walls.
  function inCell({ alongX, alongY, cells }, column, row) {
    const node = row * columns + column;
    const bits = cells[node];
    const share = (steps) => steps / work.edge_steps;
    // Corners of the cell, each followed by the place and the edge where the surface may cross the side behind it.
    const sides = [
      [[column, row], [column + share(alongX[node]), row], 2 * node],
      [[column + 1, row], [column + 1, row + share(alongY[node + 1])], 2 * node + 3],
      [[column + 1, row + 1], [column + share(alongX[node + columns]), row + 1], 2 * (node + columns)],
      [[column, row + 1], [column, row + share(alongY[node])], 2 * node + 1],
    ];
    const points = [];
    let [first, left] = [null, null];
    sides.forEach(([corner, crossing, edge], side) => {
      const [here, next] = [(bits >> side) & 1, (bits >> ((side + 1) % 4)) & 1];
      if (here) points.push(placed(...corner));
      if (here === next) return;
      const point = placed(...crossing);
      points.push(point);
      if (here) left = [point, edge];
      else if (left) wall(left, [point, edge]);
      else first = [point, edge];
      if (!here) left = null;
    });
    if (first) wall(left, first);
    return points;
  }

  function cap(points, z, normal) {
    for (let last = 2; last < points.length; last += 1) {
      for (const [x, y] of [points[0], points[last - 1], points[last]]) corner(body, x, y, z, normal);
    }
  }

  function build(place) {
    body.used = outline.used = 0;
    for (const slab of slabs) mark(slab, place);
    slabs.forEach((slab, index) => {
      const { cells, z: [low, high] } = slab;
      const caps = [[low, DOWN, slabs[index - 1]], [high, UP, slabs[index + 1]]];
      bends.length = 0;
      normals.fill(0);
      for (let row = 0; row + 1 < rows; row += 1) {
        const [begin, end] = [row * columns, (row + 1) * columns];
        // Cells that are all material, in runs, where the next slab does not cover them; a little wider than they are,
        // so that nothing shines through where runs of two rows meet.
        for (const [z, normal, next] of caps) {
          let first = -1;
          for (let cell = begin; cell < end; cell += 1) {
            const open = cells[cell] === FULL && next?.cells[cell] !== FULL;
            if (open && first < 0) first = cell;
            if (open || first < 0) continue;
            const [[left, lower], [right, upper]] = [placed(first - begin, row), placed(cell - begin, row + 1)];
            const [x, y] = [[left - spread, right + spread], [lower - spread, upper + spread]];
            cap([[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]], z, normal);
            first = -1;
          }
        }
        for (let cell = begin; cell < end; cell += 1) {
          if (cells[cell] === 0 || cells[cell] === FULL) continue;
          const points = inCell(slab, cell - begin, row);
          for (const [z, normal, next] of caps) {
            if (next?.cells[cell] !== FULL) cap(points, z, normal);
          }
        }
      }
      for (const [[p, first], [q, second]] of bends) {
        const [here, there] = [[p, normalAt(first)], [q, normalAt(second)]];
        for (const [[[x, y], normal], z] of [
          [here, low], [there, low], [there, high], [here, low], [there, high], [here, high],
        ]) corner(body, x, y, z, normal);
        for (const [z, , next] of caps) {
          if (!next) for (const [x, y] of [p, q]) corner(outline, x, y, z, UP);
        }
      }
    });
    for (const part of [body, outline]) send(part);
  }

  // Built when it is drawn: the slider may pass many places between two pictures.
  let [wanted, built] = [0, 0];
  scene.onBeforeRender = () => {
    if (!shown.visible || built === wanted) return;
    build(wanted);
    built = wanted;
  };
  // The work after the stroke at a place of the slider; at place 0 the finished gear.
  gearcut.showWork = (place) => {
    wanted = place;
    shown.visible = place > 0;
    finished.visible = place === 0;
    // What the pointer read was the finished gear's.
    if (place > 0) document.getElementById("gear-readout").textContent = "";
  };
});
