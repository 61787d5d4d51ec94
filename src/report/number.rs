//! Numbers as a person writes them.

/// A value with `digits` significant digits, without powers of ten for everyday sizes; whole numbers as they are.
pub(super) fn significant(value: f64, digits: u8) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".into() } else { "–".into() };
    }
    if value.fract() == 0.0 && value.abs() < 1e6 {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..6).contains(&exponent) {
        let mantissa = value / 10f64.powi(exponent);
        let power: String = exponent.to_string().chars().map(superscript).collect();
        return format!("{mantissa:.*} · 10{power}", usize::from(digits.saturating_sub(1)));
    }
    let decimals = (i32::from(digits) - 1 - exponent).max(0) as usize;
    format!("{value:.decimals$}")
}

/// A value with two decimals and a true minus sign.
pub(super) fn signed(value: f64) -> String {
    format!("{value:.2}").replace('-', "−")
}

/// A share as percent with three significant digits.
pub(super) fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share, 3))
}

/// A time given in s in the unit a person would use.
pub(super) fn time(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{} s", significant(s, 3)),
        s if s < 7200.0 => format!("{} min", significant(s / 60.0, 3)),
        s => format!("{} h", significant(s / 3600.0, 3)),
    }
}

fn superscript(c: char) -> char {
    match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' | '4'..='9' => char::from_u32(c as u32 - '0' as u32 + 0x2070).unwrap_or(c),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(significant(0.123_45, 3), "0.123");
        assert_eq!(significant(1234.5, 3), "1234");
        assert_eq!(significant(4.5e-14, 3), "4.50 · 10⁻¹⁴");
        assert_eq!(significant(0.0, 3), "0");
        assert_eq!(significant(f64::NAN, 3), "–");
        assert_eq!(signed(-0.567), "−0.57");
        assert_eq!(percent(0.2971), "29.7 %");
        assert_eq!((time(60.0), time(600.0), time(7200.0)), ("60 s".into(), "10 min".into(), "2 h".into()));
    }
}
