//! A progress bar, on a terminal only.

use super::say;
use crate::render::Control;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Often enough to look alive, rarely enough to cost nothing.
const REFRESH: Duration = Duration::from_millis(100);

/// Draws until dropped.
pub(crate) struct Progress {
    running: Option<Running>,
}

struct Running {
    done: Sender<()>,
    thread: JoinHandle<()>,
    bar: ProgressBar,
}

impl Progress {
    /// Starts drawing on a thread of its own, if stderr is a terminal. `limit` is what `--time` allows.
    pub(crate) fn start(control: &Arc<Control>, limit: Option<Duration>) -> Progress {
        Progress::of_frames(control, limit, Vec::new())
    }

    /// The same for several frames, which are told by their numbers.
    pub(crate) fn of_frames(
        control: &Arc<Control>,
        limit: Option<Duration>,
        frames: Vec<u32>,
    ) -> Progress {
        if !std::io::stderr().is_terminal() {
            return Progress { running: None };
        }
        let control = Arc::clone(control);
        let (done, end) = channel::<()>();
        let bar = bar();
        let drawn = bar.clone();
        let thread = std::thread::spawn(move || {
            let launched = Instant::now();
            let mut tracing_since = None;
            while end.recv_timeout(REFRESH) == Err(RecvTimeoutError::Timeout) {
                let (samples, total) = control.progress();
                if total == 0 {
                    continue;
                }
                // The build is over when tracing counts: its time says nothing about the samples to come.
                let since = *tracing_since.get_or_insert_with(Instant::now);
                let spent = launched.elapsed();
                let clock = limit.map_or(0.0, |limit| spent.as_secs_f64() / limit.as_secs_f64());
                bar.set_length(total);
                bar.set_position(samples.max((total as f64 * clock.min(1.0)) as u64));
                let by_samples = remaining(since.elapsed(), samples, total);
                let by_clock = limit.map(|limit| limit.saturating_sub(spent));
                let left = match by_samples.into_iter().chain(by_clock).min() {
                    Some(left) => format!("{} left", words(left)),
                    None => String::new(),
                };
                bar.set_message(place(samples, total, &frames) + &left);
            }
            bar.finish_and_clear();
        });
        Progress {
            running: Some(Running {
                done,
                thread,
                bar: drawn,
            }),
        }
    }

    /// Says a line above the bar.
    pub(crate) fn say(&self, line: &str) {
        match &self.running {
            Some(running) => running.bar.suspend(|| say(line)),
            None => say(line),
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(Running { done, thread, .. }) = self.running.take() {
            drop(done);
            // A drawing thread that died took only the bar with it.
            let _ = thread.join();
        }
    }
}

fn bar() -> ProgressBar {
    let bar = ProgressBar::new(0);
    let template = "{percent:>3}% [{bar:30}] {elapsed} {msg}";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}

/// Which of `frames` is being traced, and how much of it is done; nothing if there are none.
fn place(samples: u64, total: u64, frames: &[u32]) -> String {
    let share = samples as f64 / total as f64 * frames.len() as f64;
    // After the last sample of the last frame, it is still that one.
    match frames.get((share as usize).min(frames.len().saturating_sub(1))) {
        Some(frame) => format!("frame {frame}: {:.0} % · ", 100.0 * share.fract()),
        None => String::new(),
    }
}

/// Samples cost the same on average from first to last, so the rest takes as long in proportion.
fn remaining(elapsed: Duration, samples: u64, total: u64) -> Option<Duration> {
    let rest = total.saturating_sub(samples) as f64;
    (samples > 0).then(|| elapsed.mul_f64(rest / samples as f64))
}

/// `3.1 s`, `2 min 05 s`, `1 h 10 min`.
pub(crate) fn words(time: Duration) -> String {
    let seconds = time.as_secs_f64();
    if seconds < 0.001 {
        return format!("{:.0} µs", seconds * 1e6);
    }
    if seconds < 1.0 {
        return format!("{:.0} ms", seconds * 1e3);
    }
    if seconds < 59.95 {
        return format!("{seconds:.1} s");
    }
    let whole = (seconds + 0.5) as u64;
    if whole < 3600 {
        return format!("{} min {:02} s", whole / 60, whole % 60);
    }
    format!("{} h {:02} min", whole / 3600, whole % 3600 / 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_is_in_proportion() {
        let s = Duration::from_secs;
        assert_eq!(remaining(s(10), 25, 100), Some(s(30)));
        assert_eq!(remaining(s(10), 0, 100), None);
        assert_eq!(remaining(s(10), 100, 100), Some(s(0)));
    }

    #[test]
    fn frames_are_told_by_their_number() {
        assert_eq!(place(0, 400, &[]), "");
        assert_eq!(place(0, 400, &[3, 5, 7, 9]), "frame 3: 0 % · ");
        assert_eq!(place(150, 400, &[3, 5, 7, 9]), "frame 5: 50 % · ");
        assert_eq!(place(400, 400, &[3, 5, 7, 9]), "frame 9: 0 % · ");
    }

    #[test]
    fn times_read_well() {
        let of = |s: f64| words(Duration::from_secs_f64(s));
        assert_eq!(of(0.000_05), "50 µs");
        assert_eq!(of(0.25), "250 ms");
        assert_eq!(of(3.12), "3.1 s");
        assert_eq!(of(59.96), "1 min 00 s");
        assert_eq!(of(125.0), "2 min 05 s");
        assert_eq!(of(4200.0), "1 h 10 min");
    }
}
