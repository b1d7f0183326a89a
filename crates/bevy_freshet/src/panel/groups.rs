//! What the panel offers: a table for each component.
use super::{
    group::{Group, Owner},
    orbit::OrbitCamera,
    rows::{choice, row},
};
use crate::{
    body::{Water, WaterFlow, WaterFoam, WaterIce, WaterInteraction, WaterLighting, WaterOptics, WaterWaves},
    reflection::WaterReflection,
    sky::{Sky, SkyView},
    star_filter::StarFilter,
    surface::WaterSurface,
};
use core::any::TypeId;

/// Every group, in the order of the panel.
pub(super) const GROUPS: &[Group] =
    &[SKY, VIEW, STARS, ORBIT, WATER, OPTICS, LIGHTING, SURFACE, WAVES, FLOW, REFLECTION, FOAM, INTERACTION, ICE];

const SKY: Group = Group {
    title: "Sun and sky",
    owner: Owner::Sky,
    component: TypeId::of::<Sky>,
    on_release: true,
    rows: &[
        row(
            "Sun elevation",
            "sun_elevation",
            [-20.0, 90.0],
            "°",
            "Height of the sun; 0 is sunset, below −18 it is night.",
        )
        .degrees(),
        row("Sun azimuth", "sun_azimuth", [0.0, 360.0], "°", "Bearing of the sun: 0 north, 90 east.").degrees(),
        row("Turbidity", "turbidity", [1.0, 10.0], "", "Haze: 2 after rain, 3 ordinary, from 6 on hazy."),
        row("Clouds", "cloud_cover", [0.0, 1.0], "", "Share of the sky under clouds."),
        row("Cloud seed", "seed", [0.0, 100.0], "", "Which clouds and stars."),
        choice("Moon", "moon", "Where the moon stands and which phase it shows."),
        row("Starlight", "stars", [0.0, 100.0], "", "Factor on the light of the stars; nature 1.").logarithmic(),
        row("Ground albedo", "ground_albedo", [0.0, 1.0], "", "Share of the light that the land reflects."),
        row("Sky resolution", "resolution", [64.0, 2048.0], "px", "Texels along an edge; powers of two."),
    ],
};

const VIEW: Group = Group {
    title: "Exposure and haze",
    owner: Owner::Camera,
    component: TypeId::of::<SkyView>,
    on_release: false,
    rows: &[
        row("Exposure", "exposure", [-4.0, 4.0], "stops", "Brighter or darker than the sky asks for; off: left alone."),
        row(
            "Visibility",
            "visibility",
            [50.0, 20_000.0],
            "m",
            "Distance at which haze leaves 5 % contrast; off: no haze.",
        )
        .logarithmic(),
    ],
};

const STARS: Group = Group {
    title: "Star filter",
    owner: Owner::Camera,
    component: TypeId::of::<StarFilter>,
    on_release: false,
    rows: &[
        row("Star intensity", "intensity", [0.0, 10.0], "", "Light of the stars around bright spots; 0 is off.")
            .logarithmic(),
        row("Star threshold", "threshold", [0.0, 1e4], "", "Brightness from which on light makes a star.")
            .logarithmic(),
        row("Star limit", "limit", [0.0, 1e4], "", "Brightness beyond which a star grows no brighter.").logarithmic(),
        row("Arm length", "length", [0.005, 0.5], "", "Of an arm, as a share of the picture's height."),
        row("Arms", "arms", [2.0, 16.0], "", "Arms of a star."),
        row("Arm angle", "angle", [-180.0, 180.0], "°", "Of the first arm, from the right anticlockwise.").degrees(),
    ],
};

const ORBIT: Group = Group {
    title: "Orbit",
    owner: Owner::Camera,
    component: TypeId::of::<OrbitCamera>,
    on_release: false,
    rows: &[
        choice("Orbiting", "enabled", "Left button turns, wheel zooms. The free camera rests meanwhile."),
        row("Target", "target", [-1e5, 1e5], "m", "The place in the middle: x, y, z."),
        row("Distance", "distance", [0.5, 500.0], "m", "From eye to target.").logarithmic(),
        row("Elevation", "elevation", [-89.0, 89.0], "°", "Of the eye over the target.").degrees(),
        row("Azimuth", "azimuth", [-180.0, 180.0], "°", "Of the eye: 0 south, 90 east of the target.").degrees(),
    ],
};

const WATER: Group = Group {
    title: "Extent",
    owner: Owner::Water,
    component: TypeId::of::<Water>,
    on_release: true,
    rows: &[row("Size", "size", [0.0, 1e6], "m", "Length along x and z.")],
};

const OPTICS: Group = Group {
    title: "Optics",
    owner: Owner::Water,
    component: TypeId::of::<WaterOptics>,
    on_release: false,
    rows: &[
        row("Absorption", "absorption", [0.0, 10.0], "1/m", "Light lost per metre, red, green, blue."),
        row("Backscatter", "backscatter", [0.0, 2.0], "1/m", "Light thrown back per metre: turbidity."),
        row("Index", "index", [1.0, 2.0], "", "Refractive index; water 1.333."),
        choice("Fresnel", "fresnel", "How the reflected share depends on the angle."),
        row("Reflectivity", "reflectivity", [0.0, 1.0], "", "Factor on the reflected share; nature 1."),
        row("Refraction", "refraction", [0.0, 1.0], "", "How far rays are bent; nature 1."),
        row("Dispersion", "dispersion", [0.0, 0.2], "", "Difference of the index from red to blue; water 0.006."),
        row("Light path", "light_path", [0.0, 1.0], "", "How much of the sunlight's way down counts; nature 1."),
        row("Dull film", "dullness", [0.0, 1.0], "", "Share of the dull film over the water."),
        choice("Film colour", "dull_color", "Colour of the dull film."),
        row("Edge depth", "edge_depth", [0.0, 5.0], "m", "Depth over which the waterline fades in; 0 is hard.")
            .logarithmic(),
        choice("Fog", "fog", "Whether the camera's fog acts on the water."),
    ],
};

const LIGHTING: Group = Group {
    title: "Stylised light",
    owner: Owner::Water,
    component: TypeId::of::<WaterLighting>,
    on_release: false,
    rows: &[
        row("Diffuse", "diffuse", [0.0, 1.0], "", "Half-Lambert diffuse shading; nature 0."),
        row("Wave shadow", "wave_shadow", [0.0, 1.0], "", "Share of the waves' normal in the diffuse shading."),
        row("Highlight", "highlight", [0.0, 100.0], "1/sr", "Highlight of waves and level surface; 0 is off.")
            .logarithmic(),
        row("Flatness", "flatness", [0.0, 1.0], "", "Share of the level surface in the highlight."),
        row("Sharpness", "sharpness", [1.0, 1e4], "", "Exponent of the waves' highlight; higher is smaller.")
            .logarithmic(),
        row("Shininess", "shininess", [1.0, 1e4], "", "Exponent of the level surface's highlight.").logarithmic(),
        row("Tinted highlight", "tinted_highlight", [0.0, 100.0], "1/sr", "Highlight of one colour; 0 is off.")
            .logarithmic(),
        choice("Tint", "tint", "Colour of the tinted highlight."),
        row("Tint exponent", "tint_exponent", [1.0, 1e4], "", "Exponent of the tinted highlight.").logarithmic(),
        row("Translucence", "translucence", [0.0, 10.0], "", "Light that shines through the waves; 0 is off.")
            .logarithmic(),
        choice("Shine-through", "translucent_color", "Colour of the light that shines through."),
    ],
};

const SURFACE: Group = Group {
    title: "Surface",
    owner: Owner::Water,
    component: TypeId::of::<WaterSurface>,
    on_release: false,
    rows: &[
        row("Ripples", "ripples", [0.0, 0.5], "", "Root mean square slope of the fine ripples; 0 is off.")
            .logarithmic(),
        row("Ripple size", "ripple_size", [0.1, 50.0], "m", "Size of the ripples' pattern.").logarithmic(),
        row("Roughness", "roughness", [1e-4, 0.5], "", "Slope variance too small to see: spreads the glitter.")
            .logarithmic(),
        choice("Sunlight", "sunlight", "Whether sun and moon glitter."),
        row("Mesh cell", "cell", [0.005, 10.0], "m", "Spacing of the mesh near the camera.").logarithmic(),
        row("Mesh cells", "cells", [8.0, 256.0], "", "Cells across the finest part of the mesh."),
        row(
            "View scale",
            "view_scale",
            [0.01, 100.0],
            "",
            "Factor on the range of level, speed, Froude number and age.",
        )
        .logarithmic(),
        row("Mesh error", "mesh_error", [0.0, 4.0], "px", "How far off its place a coarser mesh may draw each wave."),
    ],
};

const WAVES: Group = Group {
    title: "Waves in the shallows",
    owner: Owner::Water,
    component: TypeId::of::<WaterWaves>,
    on_release: false,
    rows: &[
        row("Wave depth", "depth", [0.05, 1e4], "m", "Depth for the waves' speed; infinite is deep water.")
            .logarithmic(),
        row("Fade depth", "fade_depth", [0.0, 20.0], "m", "Depth below which waves fade to the shore; 0 is off."),
    ],
};

const FLOW: Group = Group {
    title: "Flow",
    owner: Owner::Water,
    component: TypeId::of::<WaterFlow>,
    on_release: false,
    rows: &[
        row("Flow scale", "scale", [-5.0, 5.0], "", "Factor on the flow map."),
        row("Uniform flow", "uniform", [-10.0, 10.0], "m/s", "Velocity of the whole water along x and z."),
    ],
};

const REFLECTION: Group = Group {
    title: "Reflection",
    owner: Owner::Water,
    component: TypeId::of::<WaterReflection>,
    on_release: false,
    rows: &[
        choice("Planar mirror", "planar", "Whether the scene is mirrored; off: the sky alone."),
        row("Mirror resolution", "resolution", [0.05, 1.0], "", "Size of the mirror's picture, of the view's."),
        row("Refresh", "refresh", [1.0, 8.0], "frames", "The mirror is drawn in every n-th frame."),
        choice("Own shadows", "own_shadows", "Whether the mirror draws shadow maps of its own, or uses its viewer's."),
        row("Distortion", "distortion", [0.0, 1.0], "", "How strongly waves distort the mirror; nature 1."),
        row("Mirror distance", "distance", [0.01, 1e3], "m", "Assumed distance of mirrored things.").logarithmic(),
        row("Clip offset", "clip_offset", [0.0, 1.0], "m", "How far below the surface things are mirrored.")
            .logarithmic(),
    ],
};

const FOAM: Group = Group {
    title: "Foam",
    owner: Owner::Water,
    component: TypeId::of::<WaterFoam>,
    on_release: false,
    rows: &[
        row("Foam amount", "amount", [0.0, 1.0], "", "Factor on the drawn foam; 0 is off."),
        row("Foam life", "life", [0.1, 1000.0], "s", "Time in which foam decays to 1/e.").logarithmic(),
        row("Shore foam", "shore", [0.0, 10.0], "1/s", "Foam born at the waterline.").logarithmic(),
        row("Shore depth", "shore_depth", [0.01, 10.0], "m", "Depth below which the shore makes foam.").logarithmic(),
        row("Shear foam", "shear", [0.0, 10.0], "", "Foam born per unit of shear.").logarithmic(),
        row("Shear threshold", "shear_threshold", [0.0, 100.0], "1/s", "Shear below which none is born.").logarithmic(),
        row(
            "Breaking",
            "breaking",
            [0.0, 10.0],
            "",
            "Foam born where the current runs together, per unit of convergence.",
        ),
        row("Breaking threshold", "breaking_threshold", [0.0, 100.0], "1/s", "Convergence below which none is born.")
            .logarithmic(),
        row("Speed foam", "speed", [0.0, 10.0], "1/s", "Foam born for each m/s above the threshold.").logarithmic(),
        row("Speed threshold", "speed_threshold", [0.0, 100.0], "m/s", "Speed below which none is born.").logarithmic(),
        row("Body foam", "bodies", [0.0, 10.0], "1/s", "Foam born for each m/s between body and water.").logarithmic(),
        row("Pattern size", "pattern_size", [0.05, 100.0], "m", "Size of the bubbles' pattern.").logarithmic(),
        choice("Foam albedo", "albedo", "Share of the light that foam scatters back."),
    ],
};

const INTERACTION: Group = Group {
    title: "Interaction",
    owner: Owner::Water,
    component: TypeId::of::<WaterInteraction>,
    on_release: false,
    rows: &[
        choice("Simulated", "enabled", "Whether rings, foam and dye are simulated."),
        row("Cell", "cell", [0.01, 100.0], "m", "Size of a cell; rings shorter than four cannot spread.").logarithmic(),
        row("Most cells", "cells", [16.0, 2048.0], "", "Most cells along an axis."),
        row("Rings", "rings", [0.0, 10.0], "", "Factor on the rings of bodies; nature 1, 0 is off.").logarithmic(),
        row("Ring wavelength", "wavelength", [0.05, 1000.0], "m", "Length of the rings' waves; sets their speed.")
            .logarithmic(),
        row("Ring decay", "decay", [0.05, 1000.0], "s", "Time in which rings decay to 1/e.").logarithmic(),
        row("Rain", "rain", [0.0, 500.0], "mm/h", "Drops of rain make rings.").logarithmic(),
        row("Dye spreading", "spreading", [0.0, 1.0], "m²/s", "Spreading of dye by turbulence.").logarithmic(),
        row("Dye life", "dye_life", [0.1, 1e6], "s", "Time in which dye fades to 1/e.").logarithmic(),
    ],
};

/// The switch of [`Feature::Ice`](crate::features::Feature::Ice) brings the component along.
const ICE: Group = Group {
    title: "Ice",
    owner: Owner::Water,
    component: TypeId::of::<WaterIce>,
    on_release: false,
    rows: &[
        row("Freezing", "freezing", [0.0, 1.0], "", "How much of the winter has passed: 0 open, 1 frozen over."),
        row("Thickness", "thickness", [0.1, 3.0], "m", "Of the oldest ice at the end of the winter.").logarithmic(),
        row("Level drop", "level_drop", [0.0, 1.0], "", "How far the surface sinks, as a share of the thickness."),
        row("Bank reach", "bank_reach", [0.1, 1000.0], "m", "Distance over which the bank's shelter is lost.")
            .logarithmic(),
        row("Flow limit", "flow_limit", [0.01, 100.0], "m/s", "Speed of the current above which no ice grows.")
            .logarithmic(),
        row("Snow", "snow", [0.0, 1.0], "", "Share of the ice that snow covers in the end."),
        row("Cracks", "cracks", [0.0, 1.0], "", "How strongly cracks are seen in bare ice."),
        row("Drift size", "pattern_size", [0.5, 1000.0], "m", "Size of the pattern of drifts and cracks.")
            .logarithmic(),
        row("Ice absorption", "absorption", [0.0, 100.0], "1/m", "Light lost per metre of ice, red, green, blue."),
        row("Bubbles", "scattering", [0.0, 1000.0], "1/m", "Scattering in the ice: 0.2 black ice, 20 white ice.")
            .logarithmic(),
        row("Ice roughness", "roughness", [1e-4, 0.5], "", "Slope variance of the bare ice: blurs its mirror.")
            .logarithmic(),
        choice("Snow albedo", "snow_albedo", "Share of the light that snow scatters back."),
    ],
};
