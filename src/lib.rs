//! luxel: a data-oriented, ECS-style scene renderer. A CPU path tracer.
//!
//! People author a scene as a list of entities, render it, render animations of rotating meshes frame by frame, and
//! benchmark the structure-of-arrays traversal underneath. This page is the architecture document.
//!
//! # The way of the data
//!
//! ```text
//!  scene file ──▶ SceneDesc ──▶ hecs::World(+AssetStore) ──▶ Extracted ──▶ FlatScene ──▶ pixel sums ──▶ Film ──▶ PNG/EXR
//!    (RON)        scene/          world/   (time t)           build/         flat/         trace/         film/
//! ```
//!
//! One direction, one type at every door, nothing flows back. [`render`] drives it; the command line calls [`render`].
//!
//! | module | takes | gives | never knows |
//! |---|---|---|---|
//! | [`scene`] | text | [`scene::SceneDesc`]: every default and unit; errors with line and column | hecs, pixels |
//! | [`asset`] | paths, bytes | [`asset::Mesh`] in f64, [`asset::Texture`], [`asset::Panorama`], in an immutable [`asset::AssetStore`] | the scene |
//! | [`world`] | a `SceneDesc` | a `hecs::World` of components; poses at a time | kernels |
//! | [`build`] | `&World` | [`flat::FlatScene`]: extract, flatten, tree, linearize | files, pixels |
//! | [`flat`] | | **data only**: lane blocks, cold shading arrays, materials, lights, camera, tree, needs | hecs, io, rayon |
//! | [`trace`] | `&FlatScene` | sums of radiance samples of a tile; infallible loops over SoA path state | hecs, files, rayon |
//! | [`film`] | sums | statistics, tone mapping, writers; films that still grow, as files | scenes |
//! | [`render`] | world, settings | drives build → trace → film over tiles and frames | |
//! | [`measure`] | images and references; subjects, rays and arms; a world at other sizes and places | error statistics, FLIP, heat maps; traversal timed and judged; what exactness costs; what goes wrong first; what a scene's own paths cost; what dials cost and err | what error is too much |
//! | [`check`] | a `SceneDesc`, its world and store | warnings of what is probably not meant, all at once | pixels |
//! | [`author`] | a mesh or a glTF file | a `SceneDesc`: turntable, convert | the world |
//! | [`diag`] | | **data only**: a diagnostic | everything else |
//! | [`math`] | | vectors, boxes, lanes, functions with fixed bits | everything else |
//!
//! In one crate nothing stops a module from naming another, so a test (`tests/layering.rs`) reads every path under `src/`
//! and asserts the edges.
//!
//! # Invariants
//!
//! 1. **After `build` there are only ids and arrays**: no names, paths, hecs entities or f64 transforms. (Spheres keep f64
//!    centres and radii beside their f32 boxes, for the final root.)
//! 2. **A frame is a pure function of (scene, frame number)**; nothing accumulates from frame to frame. Whether a mesh is
//!    flattened or instanced is decided from the scene alone.
//! 3. **A sample is a pure function of (scene, frame, pixel, sample index, dimension, seed)**, and a pixel is its samples
//!    added in f64: blocks of eight in the order of their index, and the blocks as a binary tree over theirs. Threads, tile
//!    size and order, SIMD width, tree shape and hecs's storage order change no bit of the image; nor does it matter how often
//!    a render was taken up again, or who traced which of its blocks.
//! 4. **No absolute epsilon in the geometry.** Each hit carries its own error bound, from which rays leave. A candidate's t is
//!    clamped into its primitive's own widened slab interval before it is compared by (t, id), and every box on the way
//!    contains that interval: no ancestor can cull a hit, so the tree's shape cannot matter.
//! 5. **Transforms compose in f64.** The build rebases by an origin and a power-of-two scale, computed once per scene from
//!    its authored rest pose, then rounds to f32 once.
//! 6. **Every choice of speed over accuracy is a named dial**; the default is exact.
//! 7. **A scene pays only for what it uses**: the build computes [`flat::Needs`], which selects the stages. Only traversal is
//!    const-generic.
//!
//! # Why an ECS
//!
//! hecs serves authoring and animation: an entity is an open set of components, parents move children, and what moved can
//! be told. It does not make tracing faster: before the first ray, everything is copied into flat arrays, and `render`
//! prints what that costs. If a scene had few kinds of entities and never moved, a struct of `Vec`s would do.
//!
//! # Departures from the first design
//!
//! * `--fresnel` also takes `off` (dielectrics reflect only totally), since the report that luxel began with shows its glass
//!   without and with Fresnel reflection.
//! * `world::Transform` holds its rotation as a matrix: quarter turns through a quaternion are not exact, and a full turn
//!   must give the rest pose to the bit. `world::Pose` keeps the root's translation apart until the build has subtracted its
//!   origin, so that a translated scene gives the same bits.
//! * `ior` lies between 0.01 and 100, beyond which f32 cannot tell transmission from nothing.
//! * A sphere counts as a wall by its *diameter*, size against size, when the extent of the scene is found.
//! * Which traversal runs is read off the buffers, not off [`flat::Needs`], whose `triangles` also counts those of instances.
//! * A triangle hit is in front of the ray if the triangle's box is, or else if t has that sign in f64: refusing it where t
//!   is smaller than its error bound lost one path in 10⁵ bounces in the corners of a closed box.
//! * Weights of a hit so near an edge that rounding may take the position past it are moved inward by three error bounds
//!   (`trace::kernels::inward`), before anything reads them: bounds along the normal do not see rounding along the surface,
//!   by which a path in 10⁷ bounces left closed rooms.
//! * Box tests do not fuse: they are the formula of the clamp itself, so that a node contains its primitives' intervals to
//!   the bit without slack; fused tests with slack took no less time.
//! * Trees of triangles alone and of spheres alone have kernels of their own; all others share one set, and trees under
//!   AVX-512 take AVX2's, since each set costs a compiler seconds and children come in eights.
//! * Rays that go one way from one place walk in packets, once sorted by direction if need be; only others are kept in
//!   flight together, where the tree outgrows the caches.
//! * Leaves are runs of at most 16 blocks, so that a child of a node is one word; where every triangle is tested, runs share
//!   a box.
//! * The metadata of an EXR stand in one text attribute, since the writer keeps attributes in a hash map, whose order would
//!   make equal renders unequal files.
//! * tobj reads the numbers of vertices that are not plain decimals, as cleaned lines, a block at a time; plain ones are
//!   read where they stand, to the same bits, which takes a third off the loading. Faces are read by a scan of our own, which
//!   has the line at hand that an error is about, resolves every index and gives a corner what its own token names: the
//!   parser would fill in the rest, and knows no lines. MTL files are read by a reader of our own. Triangles without area
//!   are dropped on reading, so that the `prim` channel counts those that are kept.
//! * The types of [`scene`] are plain, without serde: the reader cuts the text layer by layer and reads every field by
//!   itself, so that several errors of one entity are told at once, each at its place.
//! * `gltf` on an entity also takes a long form, `(path: "room.glb", lights: false)`, and `Mesh` one that names a mesh of
//!   a glTF file, `Mesh(path: "room.glb", mesh: 3)`: what `convert` writes and `turntable` needs.
//! * `background: Hdr` also takes a long form, with `rotate_deg`, `strength` and `filter`. The sky is an entity of the world.
//! * A glTF mesh without normals is flat, as its specification demands; an OBJ mesh stays smooth to 60°.
//! * The typed document of the `gltf` crate gives structure, the JSON beside it the numbers: the crate rounds them to f32.
//! * Opacity is a stage of its own behind the kernels, which know nothing of it: a ray that passes a surface leaves it by
//!   the hit's error bound and is traced again. Where a path last scattered is kept beside, so that densities stay those of
//!   the scattering.
//! * `stability` moves a scene by multiples of its own width, a power of two, since an authored unit may be a micrometre or
//!   a kilometre; and it calls a picture wrong by its own noise, since a path that passes an edge by less than the last bit
//!   may change sides. It places the root of a world by itself, for which [`measure`] names hecs.
//! * Stages of tracing are always counted and timed: a clock is read once a stage and wave, 0.1 % of the instructions.
//! * Tracing records no bounces of samples that are not finite: the few that are listed are replayed.
//! * Error bars come from blocks of the one sequence of samples that a pixel has, not from replicates of it, which would cost
//!   convergence and other bits.
//! * Samples add up as a tree over blocks of eight, not in one row, and a part film holds the nodes of that tree. Sums without
//!   rounding (bins by exponent) would have merged in any order, but take twice the memory, which the tree only takes while
//!   its nodes wait for their halves; and error bars need the nodes' means anyway.
//! * A stop does not wait for the end of a pass, which may be minutes away: every tile is saved as far as it is, by itself. So
//!   saving needs no pause either: it locks one tile after the other while the others are traced.
//! * `--time` goes on by its own measure: each run adds its time to the part that is there.
//! * Without `--checkpoint`, Ctrl-C still writes `NAME.partial.png` and exits with 130, which nothing goes on from.
//! * `farm` prints JSON for OpenJD and Kubernetes, since both take it, and names every task by its number: `--shard auto` would
//!   take another share where somebody submits a part of an array again. Its tasks ask Slurm for the requeue themselves, so that
//!   no one must set `RequeueExit`, and not once they are cancelled.
//! * The error of an image is looked at on the way only where somebody reads a log of it, and never that of a share.
//! * `--noise` and `--time` without `--spp` do not stop at the scene's samples.
//! * Samples come in fours of dimensions, which are even in base 4, as well as in pairs, which are so in base 2
//!   (`trace::sampler`): what two pairs decide together converges as what one decides alone.
//! * Lamps are also sampled through and by specular spheres (`trace::chain`), which solves one equation in a plane. It is a
//!   dial and off by default: where no caustic is seen, it costs an eighth to a third of the time for nothing.
//! * `world::AuthoringIndex` is a pair, entity and node, since one entity of a scene may stand for a file's many.
//! * What moved is not asked of hecs's `ChangeTracker`: it compares with clones, as comparing what was extracted with the
//!   frame before's does, but it needs the world mutable and does not see that a mesh became another. Poses are computed
//!   for all entities; nothing but instances, spheres, lights and the camera is made anew from them.
//! * What stands keeps its tree from frame to frame, under a small one over what moves. Nothing can deform, so that nothing
//!   is ever refitted.
//! * The box of an instance comes from a table of how far its mesh reaches in 486 directions, and is a little larger than
//!   that of its vertices, which nobody could look at in every frame.
//! * Entities enter the world a column of components at a time, into tables as large as they will be: hecs doubles a full one,
//!   and moves it. The command tells glibc to give back what is freed (`math::pages`). Both for the sake of scenes of ten
//!   thousand instances.
//! * `world::Time` is a frame and a rate, since frame / rate is rounded: a turn of whole frames is one to the bit.
//! * Frames of an animation are `NAME.partial` until they are finished, whatever the process, so that one that is killed
//!   leaves nothing that the next does not replace; they are known again by their metadata, entry by entry, so that what
//!   differs has a name.

pub mod asset;
pub mod author;
pub mod build;
pub mod check;
pub mod cli;
pub mod diag;
pub mod film;
pub mod flat;
pub mod math;
pub mod measure;
pub mod render;
pub mod scene;
pub mod trace;
pub mod world;
