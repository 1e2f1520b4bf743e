// The scene that the controls say, as gearcut reads it, and links that carry scenes.

// Harmonics of a Fourier curve that have a control.
export const HARMONICS = [1, 2, 3, 4];

const curve = {
  circle: () => "[gear.pitch_curve.circle]",
  ellipse: (of) => `[gear.pitch_curve.ellipse]\norder = ${of.order}\neccentricity = ${of.eccentricity}`,
  oval: (of) => `[gear.pitch_curve.ellipse]\norder = 2\neccentricity = ${of.eccentricity}`,
  fourier: (of) => `[gear.pitch_curve.fourier]\ncosine = [${HARMONICS.map((j) => of[`cos${j}`]).join(", ")}]`,
};

const operation = (name, strokes, offset, linkage) => `
[[operation]]
name = "${name}"
offset_mm = ${offset}
strokes_per_revolution = ${strokes}
[operation.linkage.shaping_${linkage}]
[operation.infeed.none]
`;

const shaped = (of) => `[tool.shaper_cutter]
teeth = ${of.cutter}
${operation("rough", of.rough, of.offset, of.linkage)}${operation("finish", of.finish, "0.0", of.linkage)}`;

const hobbed = (of) => `[tool.hob]
reference_diameter_mm = ${of.hob}
gashes = ${of.gashes}

[[operation]]
name = "finish"
hob_speed_per_minute = ${of.speed}
axial_feed_mm_per_revolution = ${of.feed}

`;

// What each kind of gear has of its own in the scene, and values of the controls that it begins with: a hob needs a
// convex curve, a ring one that is blunter than the cutter.
export const KINDS = {
  shaped: {
    gear: "",
    cut: shaped,
    start: { shape: "ellipse", order: 3, eccentricity: 0.1348, module: 3, teeth: 42, face: 30, cutter: 20, offset: 2 },
  },
  ring: {
    gear: 'kind = "internal"\n',
    cut: shaped,
    start: { shape: "ellipse", order: 2, eccentricity: 0.07, module: 2, teeth: 72, face: 16, cutter: 25, offset: 0.4 },
  },
  hobbed: {
    gear: "",
    cut: hobbed,
    start: { shape: "ellipse", order: 3, eccentricity: 0.1, module: 3, teeth: 42, face: 30 },
  },
};

// What is typed goes into the scene as it is: gearcut says what is wrong with it.
export function sceneText(of) {
  const { gear, cut } = KINDS[of.kind];
  return `[gear]
${gear}module_mm = ${of.module}
teeth = ${of.teeth}
face_width_mm = ${of.face}
${curve[of.shape](of)}

${cut(of)}[fields.flank]
profile_spacing_um = ${of.profile}
lead_spacing_um = ${of.lead}
`;
}

async function through(stream, bytes) {
  const out = new Blob([bytes]).stream().pipeThrough(stream);
  return new Uint8Array(await new Response(out).arrayBuffer());
}

// A scene in the part of an address that no server sees.
export async function linkOf(text) {
  const packed = await through(new CompressionStream("deflate-raw"), new TextEncoder().encode(text));
  const letters = btoa(String.fromCharCode(...packed));
  return `#scene=${letters.replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "")}`;
}

export async function sceneOf(hash) {
  const letters = /^#scene=([\w-]+)$/.exec(hash)?.[1];
  if (!letters) return null;
  const packed = Uint8Array.from(atob(letters.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
  return new TextDecoder().decode(await through(new DecompressionStream("deflate-raw"), packed));
}
