//! The report that luxel began with timed its pictures: these are ours on the same kinds of scene.
//!
//! `cargo bench --bench report`, from the project's folder. The rooms are rendered as their scenes say. The cat is traced
//! with every triangle tested, with a box around it and with the tree, at a size that the first two can bear; the three
//! images are asserted equal before any time is printed.

use luxel::build::bvh::Accel;
use luxel::render::{Control, Renderer, Rendering, Settings};
use luxel::trace::Isa;
use std::error::Error;
use std::path::Path;
use std::time::Instant;

/// Size and samples of the cat: two orders of magnitude below its scene's, since testing every triangle takes that much
/// longer.
const CAT: ((u32, u32), u32) = ((192, 192), 8);

fn main() -> Result<(), Box<dyn Error>> {
    let threads = std::thread::available_parallelism()?;
    println!("{threads} threads, {}\n", Isa::best().level());
    println!("| scene | settings | the report | luxel |\n|---|---|---:|---:|");
    for (scene, theirs) in [("diffuse_room", "14 s"), ("diffuse_room_fine", "55 s")] {
        let (_, seconds, settings) = render(scene, |_| ())?;
        row(scene, &settings, theirs, seconds);
    }
    let mut first: Option<Rendering> = None;
    for (accel, name, theirs) in [
        (Accel::Brute, "cat_room, every triangle", "–"),
        (Accel::Box, "cat_room, box", "18 min"),
        (Accel::Bvh, "cat_room, tree", "1.5 min"),
    ] {
        let (rendering, seconds, settings) = render("cat_room", |s| {
            (s.size, s.spp, s.accel) = (CAT.0, CAT.1, accel);
        })?;
        let same = first.get_or_insert_with(|| rendering.clone());
        assert_eq!(
            same.film.radiance(),
            rendering.film.radiance(),
            "{name}: another image"
        );
        row(name, &settings, theirs, seconds);
    }
    Ok(())
}

fn row(name: &str, s: &Settings, theirs: &str, seconds: f64) {
    let (width, height) = s.size;
    let (spp, bounces) = (s.spp, s.trace.max_bounces);
    println!(
        "| {name} | {width}×{height}, {spp} spp, {bounces} bounces | {theirs} | {seconds:.2} s |"
    );
}

/// Renders frame 0 of a shipped scene; the seconds hold everything from reading to the last sample.
fn render(
    scene: &str,
    change: impl Fn(&mut Settings),
) -> Result<(Rendering, f64, Settings), Box<dyn Error>> {
    let start = Instant::now();
    let path = Path::new("scenes").join(scene).with_extension("ron");
    let desc = luxel::scene::load(&path)?.desc;
    let mut settings = Settings::of_scene(&desc);
    change(&mut settings);
    let spawned = luxel::world::spawn(&desc, luxel::asset::Loader::new())
        .map_err(|errors| errors[0].to_string())?;
    let mut renderer = Renderer::new(&desc, spawned.world, &spawned.assets, settings.clone())?;
    let rendering = renderer.render(0, &Control::default());
    Ok((rendering, start.elapsed().as_secs_f64(), settings))
}
