//! Each instruction set's entries, disassembled: they run at their own width, and nothing that should have been inlined was
//! compiled apart, at the baseline.

use std::collections::BTreeMap;
use std::process::Command;

use luxel::flat::FlatScene;
use luxel::trace::{Hits, Isa, Rays, closest_hit, occluded};

/// Instructions of every function that is an entry, by its demangled name.
fn entries() -> Option<BTreeMap<String, Vec<String>>> {
    // Referenced, so that the linker keeps them in this executable.
    let kept: fn(&FlatScene, Isa, &Rays, &mut Hits) = closest_hit;
    let kept_too: fn(&FlatScene, Isa, &Rays, &mut Vec<bool>) = occluded;
    std::hint::black_box((kept, kept_too));
    let own = std::env::current_exe().ok()?;
    let output = Command::new("objdump")
        .args(["--disassemble", "--demangle", "--no-show-raw-insn"])
        .arg(own)
        .output()
        .ok()?;
    let text = String::from_utf8_lossy(&output.stdout);
    let mut all = BTreeMap::new();
    let mut current: Option<(String, Vec<String>)> = None;
    for line in text.lines() {
        if let Some(name) = line.strip_suffix(">:").and_then(|l| l.split_once('<')) {
            all.extend(current.take());
            if name.1.contains("kernels::entries::") && level(name.1).is_some() {
                // Instances of generic functions share their demangled name.
                current = Some((format!("{} {}", name.1, name.0.trim()), Vec::new()));
            }
        } else if let (Some((_, lines)), Some((_, code))) = (&mut current, line.split_once(":\t")) {
            lines.push(code.to_string());
        }
    }
    all.extend(current);
    Some(all)
}

fn level(name: &str) -> Option<&'static str> {
    ["scalar", "sse2", "avx2", "avx512"]
        .into_iter()
        .find(|level| name.contains(&format!("entries::{level}::")))
}

/// Calls through registers that an entry may have: two are seen; one lane operation that is not inlined makes at least six.
const COLD_CALLS: usize = 4;

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
    let found = match entries() {
        Some(found) if cfg!(target_arch = "x86_64") && !cfg!(debug_assertions) => found,
        _ => {
            println!("skipped: needs objdump and an optimised build for x86-64");
            return;
        }
    };
    let mut seen = BTreeMap::new();
    for (name, code) in &found {
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
        let calls = |to: &str| {
            code.iter()
                .filter(|l| l.contains("call") && l.contains(to))
                .count()
        };
        // A helper that is called often has its address in a register; so has, in cold code, a panic of a bounds check.
        assert!(calls("*%r") <= COLD_CALLS, "{name} calls a helper");
        let apart = ["lanes::", "kernels::", "core_arch::", "spawn::"].map(calls);
        assert_eq!(apart, [0; 4], "{name} calls what should be inlined");
        match level {
            "scalar" | "sse2" => assert_eq!((ymm, zmm), (0, 0), "{name}"),
            "avx2" => {
                assert!(ymm > 50 && zmm == 0, "{name} has {ymm} ymm, {zmm} zmm");
                assert!(legacy(code).is_empty(), "{name}: {:?}", legacy(code));
            }
            _ => {
                assert!(
                    zmm > 50 || name.contains("tree") && ymm > 50,
                    "{name} has {zmm} zmm"
                );
                assert!(legacy(code).is_empty(), "{name}: {:?}", legacy(code));
            }
        }
    }
    for level in ["scalar", "sse2", "avx2", "avx512"] {
        assert_eq!(seen.get(level), Some(&14), "entries of {level}: {seen:?}");
    }
}
