//! The only owner of Rapier.
