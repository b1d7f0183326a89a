//! Raster formats of hydraulic models and the flow maps made from them. Knows no engine.
