//! Unit-carrying numbers of scene files, turned to SI.
