//! The limit of intra-tablet uniformity, estimated from a run too short to reach it.

/// The limit of CoV_intra and how fast it is approached: CoV_intra²(t) = CoV_∞² + K/t.
///
/// A tablet's map after a time t is its expectation, whose CoV is the limit, and noise of independent passes, whose variance
/// relative to the mean thickness squared falls as 1/t (Freireich and Wassgren 2010, Chem. Eng. Sci. 65, 1117).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asymptote {
    /// CoV_∞², dimensionless; negative when noise wins.
    pub cov_squared: f64,
    /// K, s.
    pub noise_time: f64,
}

impl Asymptote {
    /// CoV_∞; 0 when the estimate of its square is negative.
    pub fn cov(&self) -> f64 {
        self.cov_squared.max(0.0).sqrt()
    }

    /// CoV_intra expected after a coated time, s.
    ///
    /// ```
    /// use pancoat::models::Asymptote;
    /// let limit = Asymptote { cov_squared: 0.09, noise_time: 7.0 };
    /// assert!((limit.after(100.0) - 0.4).abs() < 1e-12); // sqrt(0.09 + 0.07)
    /// assert!((limit.time_to(0.4).unwrap() - 100.0).abs() < 1e-9);
    /// assert_eq!(limit.time_to(0.3), None);
    /// ```
    pub fn after(&self, time: f64) -> f64 {
        (self.cov_squared + self.noise_time / time).max(0.0).sqrt()
    }

    /// Coated time until CoV_intra is `target`, s; `None` when the limit is not below the target.
    pub fn time_to(&self, target: f64) -> Option<f64> {
        let above = target * target - self.cov_squared.max(0.0);
        (above > 0.0).then(|| self.noise_time / above)
    }

    /// Coated time until CoV_intra is within a `share` of its limit (0.1: at 1.1 CoV_∞), s; `None` when the limit is 0,
    /// which is never approached in proportion.
    pub fn time_within(&self, share: f64) -> Option<f64> {
        (self.cov_squared > 0.0).then(|| self.time_to((1.0 + share) * self.cov())).flatten()
    }
}
