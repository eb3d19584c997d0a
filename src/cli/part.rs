//! A render that is kept on the way, or that is one machine's share: its part film, from which the same line goes on.

use super::args::RenderArgs;
use super::failure::Failure;
use super::output::{Output, check_writable};
use super::sequence::difference_of;
use super::{say, share};
use crate::film::part::{PartError, PartFile, PartWriter, encode_patch};
use crate::film::{Metadata, write_streamed};
use crate::render::{Canvas, Control, Renderer, Settings, Share, Traced, Verdict};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// What the header of a part says beside the image's metadata: entries with this before their key.
pub(crate) const OWN: &str = "part.";

/// Entries that another line may have otherwise and still go on.
const FREE: &[&str] = &[
    "spp",
    "error",
    "adaptive",
    "part.exposure",
    "part.noise",
    "part.pilot",
];

/// Where a render is kept, and what it does of the whole.
pub(crate) struct Part {
    /// The part film.
    pub(crate) path: PathBuf,
    share: Share,
    /// How often it is saved; else only when stopped or done.
    every: Option<Duration>,
    /// Keys and values of the header that are not the image's.
    own: Vec<(&'static str, String)>,
    noise: Option<f64>,
    /// Whether a time ends it, so that nobody knows how many samples there will be.
    timed: bool,
    overwrite: bool,
}

impl Part {
    /// What the arguments ask for; `None` if a render is to leave nothing but its image.
    pub(crate) fn plan(
        args: &RenderArgs,
        output: &Output,
        settings: &Settings,
    ) -> Result<Option<Part>, Failure> {
        let parts = &args.parts;
        let (share, suffix, own) = match (parts.shard, &parts.samples_range) {
            (Some(shard), _) => share::of_all(shard.here()?, parts.shard_by, settings)?,
            (None, Some(range)) => share::of_range(range, settings.spp)?,
            (None, None) if parts.checkpoint.is_some() => Default::default(),
            (None, None) => return Ok(None),
        };
        if !suffix.is_empty() && (settings.noise.is_some() || settings.time.is_some()) {
            return Err(Failure::usage(
                "shares are of a known number of samples, which --noise and --time leave open",
                "give --spp N instead",
            ));
        }
        let Some(image) = &output.path else {
            return Err(Failure::usage(
                "what goes to stdout cannot be taken up again",
                "give it a name: -o FILE.exr",
            ));
        };
        let mut path = image.clone().into_os_string();
        path.push(suffix);
        path.push(".part");
        let path = PathBuf::from(path);
        check_writable(&path)?;
        let aovs: Vec<&str> = args.dials.aov.iter().map(|aov| aov.name()).collect();
        let mut part = Part {
            path,
            share,
            every: parts.checkpoint,
            own,
            noise: settings.noise,
            timed: settings.time.is_some(),
            overwrite: parts.overwrite,
        };
        part.own.push((
            "part.aov",
            match aovs.is_empty() {
                true => "none".to_owned(),
                false => aovs.join(","),
            },
        ));
        part.own
            .push(("part.exposure", args.dials.exposure.to_string()));
        Ok(Some(part))
    }

    /// Whether it leaves an image, and not a share of one.
    pub(crate) fn is_whole(&self) -> bool {
        self.share == Share::default()
    }

    /// Renders what is missing, and saves on the way and at the end. If it was stopped, that is the failure to end with.
    pub(crate) fn render(
        &self,
        renderer: &mut Renderer,
        frame: u32,
        control: &Control,
        canvas: &Canvas,
    ) -> Result<Traced, Failure> {
        let header = renderer.metadata(frame);
        let traced = std::thread::scope(|scope| {
            // Dropped when tracing is over, which ends the waiting.
            let (_over, end) = channel::<()>();
            if let Some(every) = self.every {
                let header = &header;
                scope.spawn(move || {
                    while end.recv_timeout(every) == Err(RecvTimeoutError::Timeout) {
                        self.save_on_the_way(header, canvas, control);
                    }
                });
            }
            renderer.render_onto(frame, control, canvas)
        });
        if let Some((held, wanted)) = canvas.surplus() {
            return Err(self.too_many(held, wanted));
        }
        let nothing = canvas.samples() == 0;
        if !nothing {
            self.save(&header, canvas, || true)
                .map_err(|e| Failure::io(format!("\"{}\"", self.path.display()), &e))?;
        }
        if !traced.stats.stopped {
            return Ok(traced);
        }
        let there = match self.share.samples.as_ref().map(|range| range.start) {
            Some(start) => format!("samples {start}..{} of each pixel", canvas.done().0),
            None => format!("{} samples per pixel", canvas.done().0),
        };
        say(&match nothing {
            true => "stopped before the first sample; the same line begins again".to_owned(),
            false => format!(
                "stopped; {} has {there}, and the same line goes on",
                self.path.display()
            ),
        });
        Err(Failure::resumable())
    }

    fn save_on_the_way(&self, header: &Metadata, canvas: &Canvas, control: &Control) {
        if canvas.samples() == 0 {
            return;
        }
        // Whoever stopped it waits for what is saved at the end.
        match self.save(header, canvas, || !control.stopped()) {
            Err(e) if e.kind() != ErrorKind::Interrupted => say(&format!(
                "warning: \"{}\" is not saved, and what was there before stays: {e}",
                self.path.display()
            )),
            _ => {}
        }
    }

    /// Writes the part film, tile by tile, while others are traced.
    fn save(&self, header: &Metadata, canvas: &Canvas, go_on: impl Fn() -> bool) -> io::Result<()> {
        let mut header = self.header(header, canvas.verdict());
        if self.timed {
            header.set("spp", canvas.done().1);
        }
        write_streamed(&self.path, |out| {
            let mut part = PartWriter::begin(out, &header, canvas.len() as u32)?;
            let mut bytes = Vec::new();
            for patch in canvas.patches() {
                if !go_on() {
                    return Err(ErrorKind::Interrupted.into());
                }
                encode_patch(&patch, &mut bytes);
                drop(patch);
                part.patch(&bytes)?;
            }
            part.finish().map(drop)
        })
    }

    fn header(&self, metadata: &Metadata, verdict: Option<Verdict>) -> Metadata {
        let mut header = metadata.clone();
        for (key, value) in &self.own {
            header.push(key, value);
        }
        if let (Some(noise), Some(verdict)) = (self.noise, verdict) {
            header.set("spp", verdict.spp);
            header.push("part.noise", noise);
            header.push("part.pilot", verdict.pilot);
        }
        header
    }

    /// What is there to go on from, or nothing yet.
    pub(crate) fn canvas(&self, renderer: &Renderer, frame: u32) -> Result<Canvas, Failure> {
        let settings = renderer.settings();
        let blank = || Ok(Canvas::new(settings, &self.share));
        if self.overwrite {
            return blank();
        }
        let mut file = match PartFile::open(&self.path) {
            Ok(file) => file,
            Err(PartError::Io(e)) if e.kind() == ErrorKind::NotFound => return blank(),
            Err(e) => return Err(Failure::bad_part(&self.path, &e, ANEW)),
        };
        let wanted = self.header(&renderer.metadata(frame), None);
        // Shares of another whole are of no use to this one.
        let free = if self.is_whole() { FREE } else { &[] };
        if let Some(difference) = difference_of(&file.header, &wanted, free) {
            return Err(self.refuse(&difference));
        }
        let mut patches = Vec::new();
        for entry in file.entries.clone() {
            let patch = file.patch(&entry).ok();
            let trace = &settings.trace;
            let sound = patch.filter(|p| p.fits(settings.size, trace.features, trace.ids));
            patches.push(sound.ok_or_else(|| {
                Failure::bad_part(&self.path, &"its patches do not fit its header", ANEW)
            })?);
        }
        let canvas = Canvas::of_patches(settings.size, &self.share, patches);
        if !canvas.suits(settings) {
            return Err(self.refuse(
                "has other tiles than those that --noise gives their own samples to, which `--adaptive off` does not",
            ));
        }
        if let Some(verdict) = self.verdict_of(&file.header, settings.adaptive) {
            canvas.trust(verdict);
        }
        let (done, most) = canvas.done();
        let end = self.share.samples.as_ref().map(|range| range.end);
        let end = end.unwrap_or(settings.spp);
        if most > end {
            return Err(self.too_many(most, end));
        }
        say(
            &match done < end && canvas.verdict().is_none_or(|v| canvas.spp() < v.spp) {
                true => format!(
                    "going on from {}: sample {done} is next",
                    self.path.display()
                ),
                false => format!("{} has all samples", self.path.display()),
            },
        );
        Ok(canvas)
    }

    /// What the pilot said, if it was asked the same.
    fn verdict_of(&self, header: &Metadata, adaptive: bool) -> Option<Verdict> {
        let number = |key| header.value(key)?.parse::<u32>().ok();
        let same = header.value("part.noise")? == self.noise?.to_string()
            && header.value("adaptive").is_none() == adaptive;
        let (spp, pilot) = (number("spp")?, number("part.pilot")?);
        same.then_some(Verdict { spp, pilot })
    }

    fn too_many(&self, held: u32, wanted: u32) -> Failure {
        self.refuse(&format!(
            "has {held} samples per pixel, more than the {wanted} that are asked for"
        ))
    }

    fn refuse(&self, reason: &str) -> Failure {
        Failure::usage(
            format!("\"{}\" is there already, and {reason}", self.path.display()),
            ANEW,
        )
    }
}

const ANEW: &str = "write elsewhere with -o, or give --overwrite to begin anew";

/// The image that a part film belongs to, by its name.
pub(crate) fn image_of(part: &Path) -> Option<PathBuf> {
    let mut name = part.file_name()?.to_str()?.strip_suffix(".part")?;
    if let Some((image, share)) = name.rsplit_once('.')
        && (share.contains("-of-") || image.ends_with('.'))
    {
        // `NAME.exr.0-of-4`, or `NAME.exr.0..8`, cut at the second dot of the range.
        name = match image.strip_suffix('.') {
            Some(range) => range.rsplit_once('.')?.0,
            None => image,
        };
    }
    Some(part.with_file_name(name))
}
