//! Truncated Taylor series: a number that carries its derivatives.
//!
//! In: a formula written once with `+ - * /`, `sqrt`, `exp`, `sin_cos`, `atan2`. Out: its value and the derivatives of
//! same formula, exact to rounding. The law is the ring of power series cut off after N terms: products convolve, and
//! every elementary function follows from its differential equation by a recurrence over the coefficients (Griewank and
//! Walther, *Evaluating Derivatives*, 2008, table 13.2).
//!
//! Road not taken: derivatives written out by hand. The third derivative of a linkage fills a page, and a slip in it
//! looks like a slightly wrong acceleration. N is a constant of the type, so that `Jet<1>` costs what a plain number
//! costs.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Taylor polynomial of a function of one parameter: coefficient k is the k-th derivative divided by k!.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet<const N: usize>([f64; N]);

impl<const N: usize> Jet<N> {
    /// A constant: all derivatives zero.
    pub fn constant(value: f64) -> Self {
        let mut c = [0.0; N];
        c[0] = value;
        Self(c)
    }

    /// The parameter itself at `value`: first derivative one.
    pub fn variable(value: f64) -> Self {
        Self::linear(value, 1.0)
    }

    /// A function that is linear in the parameter.
    pub fn linear(value: f64, slope: f64) -> Self {
        let mut c = [0.0; N];
        c[0] = value;
        if N > 1 {
            c[1] = slope;
        }
        Self(c)
    }

    /// From Taylor coefficients (derivative k divided by k!).
    pub fn from_taylor(coefficients: [f64; N]) -> Self {
        Self(coefficients)
    }

    /// From the value and the derivatives.
    pub fn from_derivatives(derivatives: [f64; N]) -> Self {
        let mut c = derivatives;
        let mut factorial = 1.0;
        for (k, c) in c.iter_mut().enumerate() {
            factorial *= k.max(1) as f64;
            *c /= factorial;
        }
        Self(c)
    }

    /// The Taylor coefficients.
    pub fn taylor(&self) -> &[f64; N] {
        &self.0
    }

    /// The value.
    pub fn value(&self) -> f64 {
        self.0[0]
    }

    /// The k-th derivative; zero where the series does not reach.
    pub fn derivative(&self, k: usize) -> f64 {
        let factorial: f64 = (1..=k).map(|j| j as f64).product();
        self.0.get(k).map_or(0.0, |c| c * factorial)
    }

    /// The first M terms.
    pub fn truncate<const M: usize>(&self) -> Jet<M> {
        const { assert!(M <= N, "a series cannot grow") };
        Jet(std::array::from_fn(|k| self.0[k]))
    }

    /// The derivative with respect to the parameter: one term fewer at most.
    pub fn differentiate<const M: usize>(&self) -> Jet<M> {
        const { assert!(M < N, "the derivative has one term fewer") };
        Jet(std::array::from_fn(|k| (k + 1) as f64 * self.0[k + 1]))
    }

    /// The integral over the parameter that has the given value: one term more at most.
    pub fn integrate<const M: usize>(&self, value: f64) -> Jet<M> {
        const { assert!(M <= N + 1, "the integral has one term more") };
        Jet(std::array::from_fn(|k| if k == 0 { value } else { self.0[k - 1] / k as f64 }))
    }

    /// This function of the old parameter, the old parameter being `inner` of a new one. The value of `inner` must be
    /// the place around which this series was made.
    #[must_use]
    pub fn compose(&self, inner: &Self) -> Self {
        let mut step = *inner;
        step.0[0] = 0.0;
        self.0.iter().rev().fold(Self::constant(0.0), |sum, c| sum * step + *c)
    }

    /// 1 / x; x != 0.
    #[must_use]
    pub fn recip(&self) -> Self {
        let mut q = [0.0; N];
        q[0] = 1.0 / self.0[0];
        for k in 1..N {
            let sum: f64 = (1..=k).map(|j| self.0[j] * q[k - j]).sum();
            q[k] = -q[0] * sum;
        }
        Self(q)
    }

    /// Square root; x > 0.
    #[must_use]
    pub fn sqrt(&self) -> Self {
        let mut s = [0.0; N];
        s[0] = self.0[0].sqrt();
        for k in 1..N {
            let sum: f64 = (1..k).map(|j| s[j] * s[k - j]).sum();
            s[k] = (self.0[k] - sum) / (2.0 * s[0]);
        }
        Self(s)
    }

    /// Exponential function.
    #[must_use]
    pub fn exp(&self) -> Self {
        let mut e = [0.0; N];
        e[0] = self.0[0].exp();
        for k in 1..N {
            let sum: f64 = (1..=k).map(|j| j as f64 * self.0[j] * e[k - j]).sum();
            e[k] = sum / k as f64;
        }
        Self(e)
    }

    /// Sine and cosine.
    pub fn sin_cos(&self) -> (Self, Self) {
        let (mut s, mut c) = ([0.0; N], [0.0; N]);
        (s[0], c[0]) = self.0[0].sin_cos();
        for k in 1..N {
            for j in 1..=k {
                let w = j as f64 * self.0[j] / k as f64;
                s[k] += w * c[k - j];
                c[k] -= w * s[k - j];
            }
        }
        (Self(s), Self(c))
    }

    /// Angle of the vector (x, `self`); not both zero. From theta' = (x y' - y x') / (x^2 + y^2).
    #[must_use]
    pub fn atan2(&self, x: &Self) -> Self {
        let (y, x) = (&self.0, &x.0);
        let square: [f64; N] = std::array::from_fn(|k| (0..=k).map(|j| x[j] * x[k - j] + y[j] * y[k - j]).sum());
        let mut theta = [0.0; N];
        theta[0] = y[0].atan2(x[0]);
        for k in 1..N {
            let mut slope: f64 = (1..=k).map(|j| j as f64 * (x[k - j] * y[j] - y[k - j] * x[j])).sum();
            for j in 1..k {
                slope -= square[j] * (k - j) as f64 * theta[k - j];
            }
            theta[k] = slope / (k as f64 * square[0]);
        }
        Self(theta)
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] - other.0[k]))
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| (0..=k).map(|j| self.0[j] * other.0[k - j]).sum()))
    }
}

impl<const N: usize> Div for Jet<N> {
    type Output = Self;
    #[allow(clippy::suspicious_arithmetic_impl)] // the quotient of two series is the product with the reciprocal series
    fn div(self, other: Self) -> Self {
        self * other.recip()
    }
}

impl<const N: usize> Neg for Jet<N> {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|c| -c))
    }
}

impl<const N: usize> Add<f64> for Jet<N> {
    type Output = Self;
    fn add(mut self, other: f64) -> Self {
        self.0[0] += other;
        self
    }
}

impl<const N: usize> Sub<f64> for Jet<N> {
    type Output = Self;
    fn sub(mut self, other: f64) -> Self {
        self.0[0] -= other;
        self
    }
}

impl<const N: usize> Mul<f64> for Jet<N> {
    type Output = Self;
    fn mul(self, other: f64) -> Self {
        Self(self.0.map(|c| c * other))
    }
}

#[cfg(test)]
mod tests {
    use super::Jet;

    fn close<const N: usize>(jet: Jet<N>, derivatives: [f64; N]) {
        for (k, expected) in derivatives.into_iter().enumerate() {
            let found = jet.derivative(k);
            assert!(
                (found - expected).abs() < 1e-13 * (1.0 + expected.abs()),
                "derivative {k}: {found} not {expected}"
            );
        }
    }

    #[test]
    fn elementary_functions_carry_their_derivatives() {
        let x = 0.7_f64;
        let (s, c) = Jet::<4>::variable(x).sin_cos();
        close(s, [x.sin(), x.cos(), -x.sin(), -x.cos()]);
        close(c, [x.cos(), -x.sin(), -x.cos(), x.sin()]);
        close(Jet::<4>::variable(x).recip(), [1.0 / x, -x.powi(-2), 2.0 * x.powi(-3), -6.0 * x.powi(-4)]);
        let root = x.sqrt();
        close(Jet::<4>::variable(x).sqrt(), [root, 0.5 / root, -0.25 / root.powi(3), 0.375 / root.powi(5)]);
        // atan(x): 1 / (1 + x^2), and so on
        let q = 1.0 / (1.0 + x * x);
        let atan = Jet::<4>::variable(x).atan2(&Jet::constant(1.0));
        close(atan, [x.atan(), q, -2.0 * x * q * q, (6.0 * x * x - 2.0) * q.powi(3)]);
    }

    #[test]
    fn identities_hold_to_third_order() {
        let x = Jet::<4>::from_derivatives([1.3, -0.4, 2.5, -7.0]);
        let (s, c) = x.sin_cos();
        close(s * s + c * c, [1.0, 0.0, 0.0, 0.0]);
        close(s.atan2(&c) - x, [0.0; 4]);
        close(x.sqrt() * x.sqrt() / x, [1.0, 0.0, 0.0, 0.0]);
        let outer = Jet::<4>::variable(1.3).sin_cos().0;
        close(outer.compose(&x) - s, [0.0; 4]);
        close(x.differentiate::<3>().integrate::<4>(1.3) - x, [0.0; 4]);
    }
}
