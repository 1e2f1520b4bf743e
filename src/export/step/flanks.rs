//! Flanks as open shells of one face each, named by tooth and side, edges on the face's own boundary.

use super::{EdgeLoop, InstanceId, InstanceWriter, StepFile, StepWords, oriented, references, text, whole};
use crate::export::flank_faces::{FlankFace, FlankFaces};

/// The flanks as a file.
pub fn step(flanks: &FlankFaces, words: &StepWords) -> StepFile {
    let mut file = InstanceWriter::default();
    let shells: Vec<InstanceId> = flanks.faces.iter().map(|face| file.flank(face)).collect();
    let model = file.add(&format!("SHELL_BASED_SURFACE_MODEL({},{})", text(&words.name), references(&shells)));
    file.product(words, "MANIFOLD_SURFACE_SHAPE_REPRESENTATION", model);
    StepFile { text: whole(&file.text, words), faces: file.faces.len() }
}

impl InstanceWriter {
    /// The shell of a flank.
    fn flank(&mut self, face: &FlankFace) -> InstanceId {
        let [along, across] = &face.knots;
        let points: Vec<Vec<InstanceId>> =
            face.rows_mm.iter().map(|row| row.iter().map(|&point_mm| self.point(point_mm)).collect()).collect();
        let surface = self.surface([along, across], &points);
        let [toe, heel] = [&points[0], &points[points.len() - 1]];
        let tip = toe.len() - 1;
        let corners = [toe[0], toe[tip], heel[tip], heel[0]].map(|point| self.vertex(point));
        let [form_points, tips]: [Vec<InstanceId>; 2] =
            [0, tip].map(|column| points.iter().map(|row| row[column]).collect());
        // Round the face: up the toe, along the tip, down the heel, back along the form points.
        let sides =
            [(along, toe, [0, 1]), (across, &tips, [1, 2]), (along, heel, [3, 2]), (across, &form_points, [0, 3])];
        let mut around = EdgeLoop::new();
        for (i, (knots, controls, ends)) in sides.into_iter().enumerate() {
            let curve = self.curve(knots, controls);
            around.push((self.edge(ends.map(|corner| corners[corner]), curve), i < 2));
        }
        self.face(surface, face.is_outward, vec![oriented(around, face.is_outward)]);
        let (tooth, side) = face.flank;
        let own = self.faces[self.faces.len() - 1];
        self.add(&format!("OPEN_SHELL('tooth {tooth}, {} flank',(#{own}))", side.name()))
    }
}
