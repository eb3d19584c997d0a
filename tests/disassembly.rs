//! Each instruction set's entries, disassembled: they run at their own width, and nothing that should have been inlined was
//! compiled apart, at the baseline.

use std::collections::BTreeMap;
use std::ops::Range;
use std::process::Command;

use luxel::flat::FlatScene;
use luxel::trace::{Hits, Isa, Rays, Rect, TileSums, Tracer, closest_hit, occluded};

/// The executable taken apart.
struct Binary {
    /// Instructions of every function that is an entry, by its demangled name.
    entries: BTreeMap<String, Vec<String>>,
    /// Demangled names of functions by address.
    names: BTreeMap<u64, String>,
    /// What lies at the addresses that the loader fills in: functions are called through these.
    slots: BTreeMap<u64, Slot>,
}

/// What the loader writes into a slot.
enum Slot {
    Address(u64),
    /// Of another library.
    Symbol,
}

fn objdump(arguments: &[&str]) -> Option<String> {
    let own = std::env::current_exe().ok()?;
    let output = Command::new("objdump")
        .args(arguments)
        .arg(own)
        .output()
        .ok()?;
    Some(String::from_utf8_lossy(&output.stdout).into_owned())
}

fn hex(text: &str) -> Option<u64> {
    u64::from_str_radix(text.trim().trim_start_matches("0x"), 16).ok()
}

fn binary() -> Option<Binary> {
    // Referenced, so that the linker keeps them in this executable.
    let kept: fn(&FlatScene, Isa, &Rays, &mut Hits) = closest_hit;
    let kept_too: fn(&FlatScene, Isa, &Rays, &mut Vec<bool>) = occluded;
    let stages: fn(&mut Tracer<'static>, Rect, Range<u32>, &mut TileSums) = Tracer::trace_tile;
    std::hint::black_box((kept, kept_too, stages));
    let text = objdump(&["--disassemble", "--demangle", "--no-show-raw-insn"])?;
    let mut binary = Binary {
        entries: BTreeMap::new(),
        names: BTreeMap::new(),
        slots: slots()?,
    };
    let mut current: Option<(String, Vec<String>)> = None;
    for line in text.lines() {
        if let Some((address, name)) = line.strip_suffix(">:").and_then(|l| l.split_once('<')) {
            binary.entries.extend(current.take());
            binary
                .names
                .extend(hex(address).map(|a| (a, name.to_string())));
            if level(name).is_some() {
                // Instances of generic functions share their demangled name.
                current = Some((format!("{name} {}", address.trim()), Vec::new()));
            }
        } else if let (Some((_, lines)), Some((_, code))) = (&mut current, line.split_once(":\t")) {
            lines.push(code.to_string());
        }
    }
    binary.entries.extend(current);
    Some(binary)
}

/// By the dynamic relocations, `ADDRESS TYPE *ABS*+0xTARGET` or `ADDRESS TYPE SYMBOL`.
fn slots() -> Option<BTreeMap<u64, Slot>> {
    let text = objdump(&["--dynamic-reloc"])?;
    let slot = |line: &str| {
        let mut words = line.split_whitespace();
        let (at, _, what) = (hex(words.next()?)?, words.next()?, words.next()?);
        let target = what.strip_prefix("*ABS*+").map(hex);
        Some((
            at,
            target.map_or(Slot::Symbol, |t| Slot::Address(t.unwrap_or(0))),
        ))
    };
    Some(text.lines().filter_map(slot).collect())
}

impl Binary {
    /// Names of the functions of this executable that the code calls, through whatever: an address that is called often
    /// is loaded into a register first.
    fn called(&self, code: &[String]) -> Vec<String> {
        let mut called = Vec::new();
        for line in code {
            // `call *0xb4d3d(%rip)  # 1914f8 <…>`, `mov 0xb4d3d(%rip),%rax  # 1914f8 <…>`
            let slot = line
                .split_once("# ")
                .and_then(|(_, at)| hex(at.split(' ').next()?));
            match slot.and_then(|at| self.slots.get(&at)) {
                Some(Slot::Address(target)) => called.extend(self.names.get(target).cloned()),
                Some(Slot::Symbol) => {}
                None => {
                    let known = !line.contains("call") || !line.contains("(%rip)");
                    assert!(known, "{line}: a call that no relocation explains");
                }
            }
            if line.contains("call") && !line.contains("(%rip)") {
                called.extend(line.split_once('<').map(|(_, name)| name.to_string()));
            }
        }
        called
    }
}

fn level(name: &str) -> Option<&'static str> {
    ["scalar", "sse2", "avx2", "avx512"]
        .into_iter()
        .find(|level| {
            let kernel = format!("kernels::entries::{level}::");
            name.contains(&kernel) || name.contains(&format!("trace::stages::{level}::"))
        })
}

/// Parts of the names of what must be inlined into every entry.
const INLINED: [&str; 7] = [
    "lanes::",
    "kernels::",
    "core_arch::",
    "spawn::",
    "core::array",
    "trace::vector",
    "trace::chunk",
];

/// What hits beside edges take, one in many thousands: single numbers, no lanes.
const SELDOM: &str = "kernels::inward::step";

fn count(code: &[String], pattern: &str) -> usize {
    code.iter().filter(|line| line.contains(pattern)).count()
}

/// Instructions of the SSE encoding that compute: what code compiled at the baseline has.
fn legacy(code: &[String]) -> Vec<&String> {
    let computes = |line: &&String| {
        let name = line.split_whitespace().next().unwrap_or("");
        let suffix = ["ps", "pd", "ss", "sd"].iter().any(|s| name.ends_with(s));
        suffix && !name.starts_with('v') && line.contains("%xmm")
    };
    code.iter().filter(computes).collect()
}

#[test]
fn entries_run_at_their_own_width() {
    let binary = match binary() {
        Some(binary) if cfg!(target_arch = "x86_64") && !cfg!(debug_assertions) => binary,
        _ => {
            println!("skipped: needs objdump and an optimised build for x86-64");
            return;
        }
    };
    let mut seen = BTreeMap::new();
    let mut calls = 0;
    for (name, code) in &binary.entries {
        let level = level(name).expect("entries have a level");
        *seen.entry(level).or_insert(0) += 1;
        let [xmm, ymm, zmm] = ["%xmm", "%ymm", "%zmm"].map(|r| count(code, r));
        println!(
            "{name}: {} instructions, {xmm} xmm, {ymm} ymm, {zmm} zmm",
            code.len()
        );
        assert_eq!(
            count(code, "vfmadd") + count(code, "vfmsub") + count(code, "vfnm"),
            0,
            "{name} fuses"
        );
        assert_eq!(
            count(code, "rcpps") + count(code, "rsqrtps") + count(code, "rcp14"),
            0,
            "{name} approximates"
        );
        let called = binary.called(code);
        let apart: Vec<_> = called
            .iter()
            .filter(|to| INLINED.iter().any(|part| to.contains(part)))
            .filter(|to| !to.contains(SELDOM))
            // What is compiled apart is compiled at the baseline, where these levels run anyway.
            .filter(|to| !(to.contains("core::array") && ["scalar", "sse2"].contains(&level)))
            .filter(|to| self::level(to) != Some(level))
            .collect();
        assert!(apart.is_empty(), "{name} calls {apart:?}");
        calls += called.len();
        match level {
            "scalar" | "sse2" => assert_eq!((ymm, zmm), (0, 0), "{name}"),
            "avx2" => {
                assert!(ymm > 10 && zmm == 0, "{name} has {ymm} ymm, {zmm} zmm");
                assert!(legacy(code).is_empty(), "{name}: {:?}", legacy(code));
            }
            _ => {
                assert!(zmm > 50, "{name} has {zmm} zmm");
                assert!(legacy(code).is_empty(), "{name}: {:?}", legacy(code));
            }
        }
    }
    // Generate, surface, sample light, sample chains, sample bsdf, roulette, compact.
    let stages = 7;
    // Closest hit and occlusion: by spheres outside the tree; by a tree of triangles, of spheres, of everything, with the
    // walk of a ray and, with AVX2, of a packet; in instances, a walk of triangles likewise.
    for (level, entries) in [
        ("scalar", 2 * (1 + 2 + 1) + stages),
        ("sse2", 2 * (1 + 2 + 1) + stages),
        ("avx2", 2 * (1 + 3 * 3) + stages),
        ("avx512", 2),
    ] {
        let seen = seen.get(level);
        assert_eq!(seen, Some(&entries), "entries of {level}: {seen:?}");
    }
    // Bounds checks panic: if no call is seen, calls are not read rightly.
    assert!(calls > 0, "no entry calls anything");
}
