//! Hertz-Mindlin contact.
