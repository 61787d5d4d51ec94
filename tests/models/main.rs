//! Coating statistics and limits against cases with exact answers.

mod asymptote;
mod averages;
mod orientation;
mod tablets;
mod thz;
