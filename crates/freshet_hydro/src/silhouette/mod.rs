//! What a body shows at the waterline: its section with the water surface, and the water it displaces.
//!
//! A body is a triangle mesh in *surface coordinates*: x and z as everywhere, but y is the height above the water surface
//! at that x and z. Waves are thereby flattened to the plane y = 0, and volumes stay what they are, since a column is only
//! shifted along itself. Triangles are counter-clockwise seen from outside, as in every mesh that is culled by winding.
mod cover;
mod section;

pub use cover::Cover;
pub use section::Section;
