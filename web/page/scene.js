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

// What is typed goes into the scene as it is: gearcut says what is wrong with it.
export function sceneText(of) {
  return `[gear]
module_mm = ${of.module}
teeth = ${of.teeth}
face_width_mm = ${of.face}
${curve[of.shape](of)}

[tool.shaper_cutter]
teeth = ${of.cutter}
${operation("rough", of.rough, of.offset, of.linkage)}${operation("finish", of.finish, "0.0", of.linkage)}
[fields.flank]
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
