//! The camera: parallel rays through a rectangle of pixels.
//!
//! Parallel projection, as in drawings: lengths across the view are true everywhere, so that one scale bar holds for
//! the whole picture, and depth is the distance from the picture plane.

use glam::DVec3;

/// A camera at infinity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Place that stands in the middle of the picture, mm.
    pub target_mm: DVec3,
    /// Unit vectors: to the right, up, and towards the viewer.
    pub right: DVec3,
    /// Up in the picture.
    pub up: DVec3,
    /// From the object towards the viewer.
    pub towards: DVec3,
    /// Width of the picture at the object, mm.
    pub extent_mm: f64,
    /// Width and height, pixels.
    pub size_px: (u32, u32),
}

impl Camera {
    /// Camera that looks at `target_mm` from a direction; `up` need not be perpendicular to it.
    pub fn new(target_mm: DVec3, towards: DVec3, up: DVec3, extent_mm: f64, size_px: (u32, u32)) -> Self {
        let towards = towards.normalize();
        let right = up.cross(towards).try_normalize().unwrap_or_else(|| towards.any_orthonormal_vector());
        Self { target_mm, right, up: towards.cross(right), towards, extent_mm, size_px }
    }

    /// mm per pixel.
    pub fn pixel_mm(&self) -> f64 {
        self.extent_mm / f64::from(self.size_px.0)
    }

    /// Origin of the ray through a place of the picture (pixels from the upper left corner), `back_mm` in front of the
    /// target's plane.
    pub fn origin_mm(&self, x_px: f64, y_px: f64, back_mm: f64) -> DVec3 {
        let (width, height) = (f64::from(self.size_px.0), f64::from(self.size_px.1));
        let pixel_mm = self.pixel_mm();
        self.target_mm
            + self.right * ((x_px - 0.5 * width) * pixel_mm)
            + self.up * ((0.5 * height - y_px) * pixel_mm)
            + self.towards * back_mm
    }

    /// Direction from the target to a viewer at an azimuth (from `front` towards `left`) and an elevation over their
    /// plane.
    pub fn direction(front: DVec3, left: DVec3, azimuth_rad: f64, elevation_rad: f64) -> DVec3 {
        let over = front.cross(left);
        let (sin, cos) = elevation_rad.sin_cos();
        cos * (azimuth_rad.cos() * front + azimuth_rad.sin() * left) + sin * over
    }

    /// Centre and width of the smallest picture that shows some points, with a margin of 4 %.
    #[must_use]
    pub fn fitted(self, points_mm: &[DVec3]) -> Self {
        let across = |p: &DVec3| [self.right.dot(*p), self.up.dot(*p)];
        let Some(first) = points_mm.first().map(across) else { return self };
        let (low, high) = points_mm.iter().map(across).fold((first, first), |(low, high), p| {
            ([low[0].min(p[0]), low[1].min(p[1])], [high[0].max(p[0]), high[1].max(p[1])])
        });
        let middle = [0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])];
        let depth = self.towards.dot(self.target_mm);
        let aspect = f64::from(self.size_px.0) / f64::from(self.size_px.1);
        let extent_mm = 1.04 * (high[0] - low[0]).max((high[1] - low[1]) * aspect);
        Self { target_mm: self.right * middle[0] + self.up * middle[1] + self.towards * depth, extent_mm, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fitted_picture_holds_all_points_and_little_more() {
        let points: Vec<DVec3> =
            [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [10.0, 20.0, -3.0], [2.0, 5.0, 9.0]].map(DVec3::from_array).into();
        let towards = Camera::direction(DVec3::X, DVec3::Y, 0.4, 0.6);
        let camera = Camera::new(DVec3::ZERO, towards, DVec3::Z, 1.0, (800, 600)).fitted(&points);
        let place = |p: &DVec3| {
            let d = *p - camera.target_mm;
            [400.0 + d.dot(camera.right) / camera.pixel_mm(), 300.0 - d.dot(camera.up) / camera.pixel_mm()]
        };
        let places: Vec<[f64; 2]> = points.iter().map(place).collect();
        assert!(places.iter().all(|[x, y]| (0.0..=800.0).contains(x) && (0.0..=600.0).contains(y)), "{places:?}");
        let reach = places.iter().flat_map(|[x, y]| [(x / 400.0 - 1.0).abs(), (y / 300.0 - 1.0).abs()]);
        assert!(reach.fold(0.0, f64::max) > 0.95);
        // The ray through a point's pixel meets it again.
        let [x, y] = place(&points[2]);
        let origin = camera.origin_mm(x, y, 100.0);
        assert!((points[2] - origin).cross(camera.towards).length() < 1e-12);
        assert!(camera.up.dot(DVec3::Z) > 0.0 && camera.right.cross(camera.up).dot(camera.towards) > 0.999);
    }
}
