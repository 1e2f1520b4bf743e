//! Where a yielding tool comes to rest in the cut: the balance of cutting forces with a machine that gives way.
//!
//! In: the compliance C and the edge elements in contact, each with the thickness h of its chip at a known displacement
//! and with what the coordinates q move it along its normal ([`EdgeElement`]). Out: the displacement q at which the
//! forces of the chip that is then cut hold it there.
//!
//! Law, over elements of the edge: h = h_0 + m . (q - q_0), the force along the normal f(h) = k h + e r(h), the balance
//! `q = C (A - sum of f m)`. k and e are the element's chip and edge coefficients (K_n b, K_ne b), A what the rest of
//! the cut pushes with. The edge force exists only while a chip is cut, and a force that jumps has no balance where it
//! jumps: a tool pushed out by an edge that just cuts falls back onto it. So r rises evenly from 0 at h = 0 to 1 at the
//! least chip that counts ([`gearcut_core::cut::LEAST_CHIP_MM`]).
//!
//! Where f never falls with h, `E(q) = q . C^-1 q / 2 + sum of F(h) - A . q`, F the integral of f, is strictly convex:
//! there is one balance and no other, **whatever the compliance**. Newton's steps on E, halved where they do not lower
//! it, find it in a few steps, for E is quadratic piece by piece: its Hessian is at least that of the machine, so that
//! every step points downhill and a share of it lowers E. What ends otherwise is an error with numbers. Coordinates are
//! scaled by the square root of C; one that does not yield stays at 0.
//!
//! Oblique flanks of a cutter with much negative rake can have f that falls. E stays convex while all that falls
//! together is less stiff than the machine; beyond, balances are several or none, and the cut is refused.
//!
//! Road not taken: q <- C Q(q) over and over. It converges only while compliance times stiffness of the cut is below 1.
//! Steel has K_n of 2 N/um per mm of edge: with 10 um/kN that ends at 50 mm of edge in the cut.

use super::edge_element::EdgeElement;
use gearcut_core::error::NotConverged;
use glam::{DMat4, DVec4};
use std::fmt;

/// Newton steps at most: each piece of the force law is left at most once in practice, five steps are usual.
const MOST_STEPS: u32 = 60;
/// Halvings of a step.
const HALVINGS: usize = 40;
/// A step this small against the displacement is rounding.
const ROUNDING: f64 = 1e-13;
/// A fall of the energy this small against its parts is rounding: a sum of some hundred parts.
const FLAT: f64 = 1e-14;

/// Why there is no displacement in balance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NoBalance {
    /// Forces fall with the thickness of the chip, by more than the machine is stiff.
    NotConvex,
    /// Newton's steps do not end: forces that are not numbers.
    NotFound(NotConverged),
}

impl fmt::Display for NoBalance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotConvex => write!(
                f,
                "the cut pushes less the thicker its chips are, and the machine yields by more than that: there are \
                 several balances or none"
            ),
            Self::NotFound(lost) => lost.fmt(f),
        }
    }
}

/// Whether the energy is strictly convex, wherever the elements stand: its least Hessian is positive definite. `root`
/// scales the coordinates.
fn is_convex(root: DVec4, elements: &[EdgeElement]) -> bool {
    let mut least = DMat4::IDENTITY;
    for element in elements {
        let rate = element.least_rate();
        if rate < 0.0 {
            let m = root * element.moves;
            least += DMat4::from_cols(rate * m.x * m, rate * m.y * m, rate * m.z * m, rate * m.w * m);
        }
    }
    // All pivots of Gauss's elimination are positive, those and no other matrices are.
    let mut rows = least.to_cols_array_2d();
    (0..4).all(|i| {
        let pivot_row = rows[i];
        for row in rows.iter_mut().skip(i + 1) {
            let share = row[i] / pivot_row[i];
            row.iter_mut().zip(pivot_row).for_each(|(value, above)| *value -= share * above);
        }
        pivot_row[i] > 0.0
    })
}

/// The displacement in balance: elements seen at the displacement `seen`, a load that does not follow it (N, N mm), the
/// diagonal of C.
///
/// # Errors
/// Forces that fall with the thickness of the chip by more than the machine is stiff; no balance within 60 steps:
/// forces that are not numbers. Lengths in the error are those of scaled coordinates, square roots of N mm.
pub fn balance(diagonal: DVec4, elements: &[EdgeElement], seen: DVec4, load: DVec4) -> Result<DVec4, NoBalance> {
    // q = S s with S = sqrt(C).
    let root = DVec4::from_array(diagonal.to_array().map(f64::sqrt));
    if !is_convex(root, elements) {
        return Err(NoBalance::NotConvex);
    }
    let push = root * load;
    let energy = |s: DVec4| {
        let q = root * s;
        let of_chips: f64 = elements.iter().map(|e| e.force(e.thickness_mm + e.moves.dot(q - seen))[2]).sum();
        0.5 * s.length_squared() + of_chips - push.dot(s)
    };
    let scaled = |value: f64, root: f64| if root > 0.0 { value / root } else { 0.0 };
    let mut s = DVec4::from_array(std::array::from_fn(|i| scaled(seen[i], root[i])));
    let mut now = energy(s);
    let mut lost = NotConverged {
        what: "the balance of the cut with a machine that yields",
        after: 0,
        last: s.length(),
        last_step: f64::INFINITY,
        residual: f64::NAN,
    };
    // What the last step would still lower the energy by, and where it leads.
    let (mut fall, mut bottom) = (f64::NAN, s);
    while lost.after < MOST_STEPS {
        let q = root * s;
        let (mut gradient, mut hessian) = (s - push, DMat4::IDENTITY);
        for element in elements {
            let [force, rate, _] = element.force(element.thickness_mm + element.moves.dot(q - seen));
            let m = root * element.moves;
            gradient += force * m;
            if rate != 0.0 {
                let column = |i: usize| rate * m[i] * m;
                hessian += DMat4::from_cols(column(0), column(1), column(2), column(3));
            }
        }
        let step = -(hessian.inverse() * gradient);
        // The energy is flat to rounding before its slope is.
        let falls = gradient.dot(step);
        (fall, bottom) = (-falls, s + step);
        if step.length() <= ROUNDING * (1.0 + s.length()) || falls >= 0.0 {
            return Ok(root * bottom);
        }
        let mut share = 1.0;
        let mut halvings = 0;
        let next = loop {
            let next = energy(s + share * step);
            if next <= now + 1e-4 * share * falls {
                break Some(next);
            }
            if halvings == HALVINGS {
                break None;
            }
            share *= 0.5;
            halvings += 1;
        };
        lost.after += 1;
        (lost.residual, lost.last_step) = (gradient.length(), share * step.length());
        let Some(next) = next else { break };
        (s, now) = (s + share * step, next);
        lost.last = s.length();
    }
    let parts = now.abs() + 0.5 * s.length_squared() + push.dot(s).abs();
    if fall <= FLAT * parts { Ok(root * bottom) } else { Err(NoBalance::NotFound(lost)) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gearcut_core::cut::LEAST_CHIP_MM;
    use glam::Vec4Swizzles;

    fn element(thickness_mm: f64, moves: DVec4, chip_n_per_mm: f64, edge_n: f64) -> EdgeElement {
        EdgeElement { thickness_mm, moves, chip_n_per_mm, edge_n }
    }

    /// d = C F_0 / (1 + C k) for a chip whose force is F_0 + k (h - h_0), the machine seen anywhere.
    #[test]
    fn one_element_rests_where_the_closed_form_says() {
        for (c, k, h, edge_n) in [(1e-5, 4e3, 0.05, 0.0), (1e-5, 4e4, 0.05, 90.0), (1e-3, 4e5, 0.2, 20.0)] {
            let moves = -DVec4::X;
            let exact_mm = c * (k * h + edge_n) / (1.0 + c * k);
            for seen_mm in [0.0, 0.3 * exact_mm, 1.2 * exact_mm] {
                let seen = DVec4::X * seen_mm;
                let element = element(h - seen_mm, moves, k, edge_n);
                let q = balance(DVec4::X * c, &[element], seen, DVec4::ZERO).unwrap();
                assert!((q.x / exact_mm - 1.0).abs() < 1e-12 && q.yzw() == glam::DVec3::ZERO, "{q} for {exact_mm}");
            }
        }
    }

    /// An edge force that a yielding machine cannot hold: the edge just touches, with the share of it that is needed.
    #[test]
    fn a_tool_that_is_pushed_out_by_its_edge_alone_rubs() {
        let (c, h, edge_n) = (1e-3, 0.01, 40.0);
        let q = balance(DVec4::X * c, &[element(h, -DVec4::X, 0.0, edge_n)], DVec4::ZERO, DVec4::ZERO).unwrap();
        let left_mm = h - q.x;
        assert!(left_mm > 0.0 && left_mm < LEAST_CHIP_MM, "{left_mm}");
        assert!((q.x / c / (edge_n * left_mm / LEAST_CHIP_MM) - 1.0).abs() < 1e-9);
    }

    /// Many elements in all four coordinates against small steps towards C Q(q), which need no derivative, where those
    /// converge and where q <- C Q(q) does not.
    #[test]
    fn many_elements_rest_where_small_steps_lead() {
        let diagonal = DVec4::new(1.2e-5, 1e-5, 1e-9, 5e-10);
        let load = DVec4::new(300.0, -200.0, 4e3, 9e3);
        for scale in [0.1, 1.0, 30.0] {
            let diagonal = scale * diagonal;
            let elements: Vec<EdgeElement> = (0..300)
                .map(|i| {
                    let (a, b) = (0.37 * f64::from(i), 0.011 * f64::from(i));
                    let n = glam::DVec2::from_angle(a.sin() + std::f64::consts::PI);
                    let moves = DVec4::new(n.x, n.y, 30.0 * b.cos(), 60.0 * n.y);
                    element(0.03 * (1.0 + a.cos()) * b, moves, 90.0, if i % 3 == 0 { 2.0 } else { 0.0 })
                })
                .collect();
            let wanted = |q: DVec4| {
                let on = |e: &EdgeElement| e.force(e.thickness_mm + e.moves.dot(q))[0] * e.moves;
                diagonal * (load - elements.iter().map(on).sum::<DVec4>())
            };
            let mut slow = DVec4::ZERO;
            for _ in 0..2_000_000 {
                let step = 1e-4 * (wanted(slow) - slow);
                slow += step;
                if step.length() < 1e-15 {
                    break;
                }
            }
            let q = balance(diagonal, &elements, DVec4::ZERO, load).unwrap();
            let off = (q - slow).abs() / slow.abs().max(DVec4::splat(1e-9));
            println!("{q} {slow}");
            assert!(off.max_element() < 1e-6, "{q} {slow} at {scale}");
            // Seen from elsewhere, the same.
            let seen = 0.5 * q;
            let moved: Vec<EdgeElement> = elements
                .iter()
                .map(|e| EdgeElement { thickness_mm: e.thickness_mm + e.moves.dot(seen), ..*e })
                .collect();
            assert!((balance(diagonal, &moved, seen, load).unwrap() - q).abs().max_element() < 1e-12);
        }
    }

    /// A force that falls with the thickness leaves one balance while the machine is stiffer, d = C F_0 / (1 + C k) as
    /// ever, and is refused beyond. Alone or together: ten elements fall ten times as fast, and those that rise
    /// elsewhere do not make up for it.
    #[test]
    fn forces_that_fall_faster_than_the_machine_is_stiff_are_refused() {
        let (c, h) = (1e-3, 0.05);
        let of = |count: usize, chip_n_per_mm: f64, edge_n: f64| {
            let rising = element(h, DVec4::Y, 4e4, 30.0);
            let mut elements = vec![element(h, -DVec4::X, chip_n_per_mm, edge_n); count];
            elements.push(rising);
            balance(DVec4::X * c, &elements, DVec4::ZERO, DVec4::ZERO)
        };
        for (count, k) in [(1, -0.9 / c), (10, -0.09 / c)] {
            let exact_mm = c * count as f64 * k * h / (1.0 + c * count as f64 * k);
            let found_mm = of(count, k, 0.0).unwrap().x;
            assert!((found_mm / exact_mm - 1.0).abs() < 1e-9, "{found_mm} for {exact_mm}");
        }
        for (count, k) in [(1, -1.1 / c), (10, -0.11 / c)] {
            assert_eq!(of(count, k, 0.0), Err(NoBalance::NotConvex), "{count} elements");
        }
        // An edge that pulls: without the material it stays out, and once in it stays in.
        let pull_n = -2.0 * LEAST_CHIP_MM / c;
        assert_eq!(of(1, 0.0, pull_n), Err(NoBalance::NotConvex));
        assert!(of(1, 0.0, 0.4 * pull_n).is_ok());
        assert!(of(1, f64::NAN, f64::NAN).is_err());
    }

    /// What has no balance is no displacement: it ends with an error and its numbers, not with the last try.
    #[test]
    fn forces_that_are_no_numbers_end_with_an_error() {
        let lost = balance(DVec4::ONE, &[element(f64::NAN, -DVec4::X, 1e4, 5.0)], DVec4::ZERO, DVec4::ZERO);
        let Err(NoBalance::NotFound(lost)) = lost else { panic!("{lost:?}") };
        assert!(lost.residual.is_nan() && lost.after == 1, "{lost}");
        assert!(lost.to_string().contains("the balance of the cut with a machine that yields is not found"), "{lost}");
    }
}
