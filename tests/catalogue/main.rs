//! The catalogue: what goes wrong at the extremes of numbers, tried on purpose.
//!
//! Every item is a construction with something that must hold: a ray that must hit, a bound, an equality to the bit. Quick
//! ones run at every commit; the same items, as often as their bars ask for, run by
//!
//! ```sh
//! cargo test --release --test catalogue deep -- --ignored --nocapture
//! ```
//!
//! which also writes the README's table, to `target/tmp/catalogue.md`. That takes an hour on two cores;
//! `CATALOGUE_TRIALS=1e7` before it tries nothing more often than that. Seeds are fixed, so that a run can be repeated. 0
//! failures of N trials mean less than one in N / 3 (with 95 % certainty).
//!
//! | items | where |
//! |---|---|
//! | A triangles: 1 edges, 2 vertices, 3 lattice, 4 far ball | `a_triangles` |
//! | A5 powers of two, 9 self-hits, 10 neighbours, 12 gaps, 14 millions | `a_leaving` |
//! | A15 edges from inside | `a_edges` |
//! | A6 accuracy, 7 grazing, 8 degenerate, 11 coincident | `a_bounds` |
//! | A13 sizes beyond f32 | `j_invariance` |
//! | B spheres: 1 walls, 3 far and small, 4 grazing, 5 leaving, 6 nested, 8 normals | `b_spheres` |
//! | B2 six walls | `g_transport` |
//! | B7 touching, B9 as lights | `f_lights`, `light::radiance` |
//! | C1 turned rooms | `c_rooms` |
//! | C transforms | `tests/world`, `kernels::leave`, `light::agreement` |
//! | D trees: 1 corners, 2 zeros, 3 equality, 4 order, 6 bad rays, 7 work | `d_trees`; 1 also `trace::kernels::ray` |
//! | D5 boxes contain what is in them (none are quantised) | `kernels::trees` |
//! | E1 to E4 sampling | `trace::vector`, `trace::light`; by estimators: `light::estimators`, `light::agreement` |
//! | E5 white furnaces, E6 and E8 Fresnel | `light::furnace`, `trace::fresnel`, `build::fresnel` |
//! | E7 refraction | `light::agreement`, G7 |
//! | E9 shading normals | `light::acne`, `light::agreement` |
//! | E10 numbers at the ends, H7 random numbers | `trace::sampler` |
//! | F lights: 1 any angle, 4 close blockers, 6 huge | `f_lights`; 2 and 7 `trace::light`; 3 H2; 8 `light::agreement`; 9 J6 |
//! | G transport: 1 furnaces, 4 a thousand bounces, 5 depth, 7 rainbow | `g_transport` |
//! | G2, G6 closed forms, G3, G4 estimators, G9 the f64 reference | `light::radiance`, `light::estimators`, `light::agreement` |
//! | H numbers: 1 sums, 2 not finite, 5 all of f32 | `h_numbers` |
//! | H3 metrics, H4 damaged files | `measure`, `tests/mutate` |
//! | I camera and textures: 1 blur and pinhole | `light::radiance`, `light::invariance`; 3, 4 `light::textures`, `light::oracle_uv` |
//! | J invariance: 2 mirrored, 3 threads and trees, 6 light, 7 parts, 8 unseen and cut | `j_invariance`; 5 turned `f_lights` |
//! | J1 size, J4 place | `light::invariance` |
//! | J9 machines | `tests/golden.rs`, to the bit |
//!
//! Not tried: rough metals, of which there are none yet (E5); reciprocity of materials and scenes (E4, G8); flushing of
//! subnormal numbers (H6); footprints and horizons (I2, I5).

mod a_bounds;
mod a_edges;
mod a_leaving;
mod a_triangles;
mod b_spheres;
mod book;
mod c_rooms;
#[path = "../light/closed.rs"]
#[allow(dead_code, reason = "the light tests use all of it")]
mod closed;
mod d_trees;
mod f_lights;
mod g_transport;
mod h_numbers;
mod j_invariance;
#[path = "../light/luxel_side.rs"]
#[allow(dead_code, reason = "the light tests use all of it")]
mod luxel_side;
#[path = "../light/objs.rs"]
#[allow(dead_code, reason = "the light tests use all of it")]
mod objs;
#[path = "../reference/mod.rs"]
#[allow(dead_code, unused_imports, reason = "the light tests use all of it")]
mod reference;
mod rooms;
mod scenes;
#[path = "../light/stats.rs"]
#[allow(dead_code, reason = "the light tests use all of it")]
mod stats;
#[path = "../support/mod.rs"]
mod support;
