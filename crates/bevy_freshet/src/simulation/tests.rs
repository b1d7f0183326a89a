//! The stages on a GPU against their twins.
