//! The arguments of `bench`.

use super::args::{parse_isa, parse_memory, parse_time};
use crate::measure::arms::{Layout, Tree};
use crate::measure::bench::{Generator, RayKind};
use crate::trace::Isa;
use clap::builder::PossibleValuesParser;
use clap::builder::TypedValueParser;
use clap::{Args, value_parser};
use std::path::PathBuf;
use std::time::Duration;

/// `luxel bench`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  luxel bench                                      a small and a large mesh, about a minute
  luxel bench --mesh dragon.obj --csv dragon.csv   your mesh, for a spreadsheet
  luxel bench --size 1m --rays random --isa scalar,sse2,avx2
  luxel bench --size spheres-100 --accel bvh8,brute --layout blocks,luxel
  luxel bench --accel bvh8,bvh8q --layout fours,blocks --isa avx2
  luxel bench --all --svg all.svg                  everything; half an hour and more, 4 GB
  luxel bench --exactness                          watertight, widened, f64: what each costs, what it saves from

Layouts of primitives: structs (an array of them, one tested at a time), gathered (the same, eight gathered into lanes),
arrays (one for every coordinate), fours (blocks of four lanes), blocks (of eight), luxel (what `render` runs). Trees: bvh2
(two children a node), bvh8 (eight), bvh8q (eight, their boxes in bytes: half the memory), box (one around the object),
brute (none). Leaves and rays are the same for all of them, and so must their hits be, to the bit; that is checked before
anything is timed. What no comparison needs is left out: gathered and fours go with bvh8, bvh8q with blocks of triangles.
Times are CPU times of one thread, the least of several passes that the arms take in turns.")]
pub(crate) struct BenchArgs {
    /// What to trace, separated by commas: balls in a room of 3k to 4m triangles, an open terrain of 4 M, a soup of
    /// 200,000 thin triangles, spheres [default: 3k,1m]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = one_of(&Generator::ALL, Generator::name))]
    pub(crate) size: Vec<Generator>,
    /// A mesh of yours: .obj, .gltf or .glb
    #[arg(long, value_name = "FILE")]
    pub(crate) mesh: Option<PathBuf>,
    /// Put a closed room around --mesh, so that every ray hits something
    #[arg(long, requires = "mesh")]
    pub(crate) room: bool,
    /// Ray sets [default: all]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = one_of(&RayKind::ALL, RayKind::name))]
    pub(crate) rays: Vec<RayKind>,
    /// Layouts of the primitives [default: structs,arrays,blocks,luxel]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = one_of(&Layout::ALL, Layout::name))]
    pub(crate) layout: Vec<Layout>,
    /// Trees; box and brute test every primitive and are left out where that takes too long [default: bvh8]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = one_of(&Tree::ALL, Tree::name))]
    pub(crate) accel: Vec<Tree>,
    /// Instruction sets: scalar, sse2, avx2, avx512 (luxel only) [default: all but sse2]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = parse_isa)]
    pub(crate) isa: Vec<Isa>,
    /// What exactness costs: six choices of luxel, each timed and judged beside its cheap twin
    #[arg(long, conflicts_with_all = ["size", "mesh", "room", "rays", "layout", "accel", "isa", "all", "svg"])]
    pub(crate) exactness: bool,
    /// Everything above that is not named
    #[arg(long)]
    pub(crate) all: bool,
    /// Primary and random rays; the other sets have as many as hit something
    #[arg(long, value_name = "N", default_value_t = 1 << 17, value_parser = value_parser!(u32).range(1..=1 << 24))]
    pub(crate) count: u32,
    /// What the run should take; three passes are made in any case
    #[arg(long, value_name = "TIME", default_value = "45s", value_parser = parse_time)]
    pub(crate) time: Duration,
    /// Write all numbers as comma-separated values
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
    /// Write a chart
    #[arg(long, value_name = "FILE")]
    pub(crate) svg: Option<PathBuf>,
    /// Print JSON in place of the table
    #[arg(long)]
    pub(crate) json: bool,
    /// Most memory that --mesh may take: 512M, 8G
    #[arg(long, value_name = "SIZE", default_value = "4G", value_parser = parse_memory)]
    pub(crate) max_memory: u64,
}

/// A parser of the names of these values.
fn one_of<T: Copy + Send + Sync + 'static>(
    all: &'static [T],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(all.iter().map(move |&value| name(value))).try_map(move |text| {
        let named = all.iter().find(|&&value| name(value) == text);
        named.copied().ok_or("no such value")
    })
}
