//! Dual numbers: a value with its exact derivatives, by forward differentiation.

use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Real;
use crate::table::{ByteTable, FloatTable, PairTable};

/// A value with its partial derivatives along `N` directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<R, const N: usize> {
    /// The value.
    pub value: R,
    /// The derivative of the value along each direction.
    pub gradient: [R; N],
}

impl<R: Real, const N: usize> Dual<R, N> {
    /// A point whose coordinates are the directions: coordinate `i` has the derivative 1 along `i`, and 0 along the others.
    #[inline(always)]
    pub fn point(coordinates: [R; N]) -> [Self; N] {
        std::array::from_fn(|axis| {
            let gradient = std::array::from_fn(|i| R::constant(if i == axis { 1.0 } else { 0.0 }));
            Dual { value: coordinates[axis], gradient }
        })
    }

    /// This value, and each derivative through `change`.
    #[inline(always)]
    fn with(self, value: R, change: impl Fn(R) -> R) -> Self {
        let mut gradient = self.gradient;
        for part in &mut gradient {
            *part = change(*part);
        }
        Dual { value, gradient }
    }

    /// This value, and the derivatives of both through `change`.
    #[inline(always)]
    fn with_both(self, other: Self, value: R, change: impl Fn(R, R) -> R) -> Self {
        let mut gradient = self.gradient;
        for (part, &its) in gradient.iter_mut().zip(&other.gradient) {
            *part = change(*part, its);
        }
        Dual { value, gradient }
    }
}

impl<R: Real, const N: usize> Add for Dual<R, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.with_both(other, self.value + other.value, |a, b| a + b)
    }
}

impl<R: Real, const N: usize> Sub for Dual<R, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.with_both(other, self.value - other.value, |a, b| a - b)
    }
}

impl<R: Real, const N: usize> Mul for Dual<R, N> {
    type Output = Self;
    #[inline(always)]
    #[allow(clippy::suspicious_arithmetic_impl, reason = "the product rule")]
    fn mul(self, other: Self) -> Self {
        self.with_both(other, self.value * other.value, |a, b| a * other.value + self.value * b)
    }
}

impl<R: Real, const N: usize> Div for Dual<R, N> {
    type Output = Self;
    #[inline(always)]
    #[allow(clippy::suspicious_arithmetic_impl, reason = "the quotient rule")]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        self.with_both(other, value, |a, b| (a - value * b) / other.value)
    }
}

impl<R: Real, const N: usize> Neg for Dual<R, N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.with(-self.value, |a| -a)
    }
}

impl<R: Real, const N: usize> Real for Dual<R, N> {
    type Int = R::Int;
    type Mask = R::Mask;
    const DOUBLE: bool = R::DOUBLE;
    const SCALAR: bool = R::SCALAR;

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Dual { value: R::constant(value), gradient: [R::constant(0.0); N] }
    }
    #[inline(always)]
    fn floor(self) -> Self {
        self.with(self.value.floor(), |_| R::constant(0.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        let negative = self.value.less(R::constant(0.0));
        self.with(self.value.abs(), |a| R::select(negative, -a, a))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // At zero, where the root has no slope, the derivative is given as 0.
        let root = self.value.sqrt();
        let positive = R::constant(0.0).less(root);
        self.with(root, |a| R::select(positive, a / (root + root), R::constant(0.0)))
    }
    #[inline(always)]
    fn less(self, other: Self) -> R::Mask {
        self.value.less(other.value)
    }
    #[inline(always)]
    fn select(mask: R::Mask, yes: Self, no: Self) -> Self {
        yes.with_both(no, R::select(mask, yes.value, no.value), |a, b| R::select(mask, a, b))
    }
    #[inline(always)]
    fn select_int(mask: R::Mask, yes: R::Int, no: R::Int) -> R::Int {
        R::select_int(mask, yes, no)
    }
    #[inline(always)]
    fn to_int(self) -> R::Int {
        self.value.to_int()
    }
    #[inline(always)]
    fn from_int(value: R::Int) -> Self {
        Dual { value: R::from_int(value), gradient: [R::constant(0.0); N] }
    }
    #[inline(always)]
    fn times_power_of_two(self, exponent: R::Int) -> Self {
        self.with(self.value.times_power_of_two(exponent), |a| a.times_power_of_two(exponent))
    }
    #[inline(always)]
    fn split_exponent(self) -> (Self, Self) {
        let (mantissa, exponent) = self.value.split_exponent();
        let scale = mantissa / self.value;
        let zero = [R::constant(0.0); N];
        (self.with(mantissa, |a| a * scale), Dual { value: exponent, gradient: zero })
    }
    #[inline(always)]
    fn lookup(table: &ByteTable, index: R::Int) -> R::Int {
        R::lookup(table, index)
    }
    #[inline(always)]
    fn lookup_pair(table: &PairTable, index: R::Int) -> (R::Int, R::Int) {
        R::lookup_pair(table, index)
    }
    #[inline(always)]
    fn pick(table: &FloatTable, index: R::Int) -> Self {
        Dual { value: R::pick(table, index), gradient: [R::constant(0.0); N] }
    }
}
