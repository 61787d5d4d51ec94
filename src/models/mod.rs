//! Coating statistics and asymptotes from stored data.
