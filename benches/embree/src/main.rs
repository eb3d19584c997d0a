//! luxel beside Embree: the same rays, in turns, in one run, on one thread.
//!
//! ```text
//! pip download --no-deps embreex==4.4.0.post1 && unzip embreex-*.whl 'embreex.libs/*'
//! cargo run --release -p luxel-embree -- --embree embreex.libs/libembree4-*.so.4
//! cargo run --release -p luxel-embree -- --embree ... --mesh dragon.obj --markdown
//! ```
//!
//! Of Embree it is `rtcIntersect1` and `rtcOccluded1`, one ray at a time as a path tracer asks, with medium build quality,
//! in default and in robust mode, the better of its AVX2 and its AVX-512 kernels for each set of rays. Of luxel it is
//! what renders. Every hit of every engine is judged by luxel's f64 referee: luxel by its own bounds, Embree by a loose rule.
//!
//! Times are CPU time of the thread; a set of rays is cut into chunks, a chunk's time is its smallest over the passes, and
//! the engines take turns pass by pass: a busy machine disturbs all alike, and little.
//!
//! Deliberately absent: packets, streams, and Embree's compact and high-quality trees.

mod bars;
mod embree;
mod engine;
mod measure;
mod subjects;
mod table;

use clap::Parser;
use embree::Embree;
use std::error::Error;
use std::fs::File;
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;

/// luxel's traversal beside Embree's, on the same rays in the same run.
#[derive(Parser)]
#[command(name = "luxel-embree")]
struct Arguments {
    /// The library, libembree4.so; LUXEL_EMBREE by default
    #[arg(long, value_name = "FILE")]
    embree: Option<PathBuf>,
    /// Subjects by name; all if none is named
    #[arg(value_name = "SUBJECT")]
    subjects: Vec<String>,
    /// A mesh (OBJ or glTF binary) in place of the generated ones
    #[arg(long, value_name = "FILE", conflicts_with = "subjects")]
    mesh: Option<PathBuf>,
    /// Primary and random rays of each subject
    #[arg(long, default_value_t = 1 << 20)]
    rays: usize,
    /// Passes over each set of rays
    #[arg(long, default_value_t = 7)]
    passes: usize,
    /// Print the table as Markdown
    #[arg(long)]
    markdown: bool,
    /// Also write one line for each engine and set
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

/// What to do without the library.
const HOW_TO_GET_EMBREE: &str =
    "name Embree's library by --embree FILE or LUXEL_EMBREE; PyPI has it for Linux:
    pip download --no-deps embreex==4.4.0.post1
    unzip embreex-*.whl 'embreex.libs/*'    # embreex.libs/libembree4-*.so.4";

fn main() -> ExitCode {
    match run(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), Box<dyn Error>> {
    let path = arguments.embree.clone();
    let path = path.or_else(|| std::env::var_os("LUXEL_EMBREE").map(PathBuf::from));
    let path = path.ok_or(HOW_TO_GET_EMBREE)?;
    let embree = Embree::open(&path).map_err(|error| {
        let reason = error.source().and_then(Error::source);
        let reason = reason.map_or(String::new(), |reason| format!(": {reason}"));
        format!("{error}{reason}\n{HOW_TO_GET_EMBREE}")
    })?;
    let makers = match &arguments.mesh {
        Some(path) => vec![subjects::of_file(path)?],
        None => subjects::named(&arguments.subjects)?,
    };
    let mut csv = arguments.csv.as_ref().map(File::create).transpose()?;
    if let Some(file) = &mut csv {
        writeln!(file, "{}", table::CSV_HEADER)?;
    }
    println!(
        "luxel {} and Embree {}, one thread, {} rays, {} passes, {}\n",
        env!("CARGO_PKG_VERSION"),
        embree.version()?,
        arguments.rays,
        arguments.passes,
        subjects::cpu(),
    );
    for (name, make) in makers {
        let subject = make();
        let rows = measure::measure(&subject, &embree, arguments.rays, arguments.passes)?;
        print!(
            "{}",
            table::text(&name, &subject, &rows, arguments.markdown)
        );
        if let Some(file) = &mut csv {
            file.write_all(table::csv(&name, &subject, &rows).as_bytes())?;
        }
    }
    Ok(())
}
