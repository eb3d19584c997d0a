#!/usr/bin/env bash
# Proves the jobs that `luxel farm` prints on the schedulers themselves: Slurm, OpenJD and GNU parallel, on this machine.
#
#     tests/farm/prove.sh [slurm] [openjd] [parallel]
#
# Each renders an animation of 8 frames and a still in 4 shares of its samples. One task is stopped midway by SIGTERM and
# must go on from what it saved; all files must be those of a plain run, byte for byte. On Slurm, a task whose scene went
# bad must not be queued again. Takes some minutes. Installs what is missing (Debian packages, as root; openjd-cli from
# PyPI in an environment of its own), starts daemons on the loopback address, and stops them at the end.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
here=$PWD
work=$(mktemp -d "${TMPDIR:-/tmp}/luxel-farm.XXXXXX")
# Munge wants a socket that everybody can reach.
chmod 711 "$work"

stop() {
    code=$?
    # Tasks that still run, then the daemons and whatever else was started.
    if [ "${SLURM_CONF:-}" = "$work/slurm/slurm.conf" ]; then
        timeout 10 scancel --user="$(id -un)" 2>/dev/null && sleep 2
    fi
    for pid in $(jobs -p); do
        kill "$pid" 2>/dev/null || true
    done
    wait
    if [ "$code" = 0 ]; then
        rm -rf "$work"
    else
        echo "failed; everything is in $work" >&2
    fi
}
trap stop EXIT

say() { printf '\n== %s\n' "$*"; }
fail() { echo "error: $*" >&2; exit 1; }

# await SECONDS COMMAND..: until it succeeds.
await() {
    local left=$(($1 * 5))
    shift
    until "$@"; do
        left=$((left - 1))
        [ "$left" -gt 0 ] || fail "waited in vain for: $*"
        sleep 0.2
    done
}

needs() {
    local missing=()
    for pair in "$@"; do
        command -v "${pair%%=*}" >/dev/null || missing+=("${pair##*=}")
    done
    [ "${#missing[@]}" = 0 ] && return
    say "installing ${missing[*]}"
    apt-get update -qq
    DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# What a task renders: a few seconds on one core.
frames=(--frames 0..8 --size 192x128 --spp 256)
still=(--size 192x128 --spp 1024)

references() {
    cargo build --release
    luxel=$here/target/release/luxel
    cp -r scenes assets "$work"
    cd "$work"
    say "plain runs"
    "$luxel" animate scenes/gears.ron -o plain/gears_####.png "${frames[@]}" 2>/dev/null >&2
    "$luxel" render scenes/materials.ron -o plain/materials.exr "${still[@]}" 2>/dev/null >&2
}

# same FOLDER NAME..: the files of the plain run, and beside shares and logs no others.
same() {
    local folder=$1 name
    shift
    for name in "$@"; do
        cmp "plain/$name" "$folder/$name" || fail "$folder/$name is another file"
    done
    echo "$folder: $# files equal to the bit"
}
same_frames() { same "$1" gears_000{0..7}.png; }
same_still() { same "$1" materials.exr; }

# job KIND FRAMES_OR_STILL FOLDER
job() {
    case $2 in
    frames) "$luxel" farm "$1" scenes/gears.ron --out "$3" --shards 4 --cpus 1 --memory 256M -- "${frames[@]}" ;;
    still) "$luxel" farm "$1" scenes/materials.ron --out "$3" --shards 4 --cpus 1 --memory 256M --format exr -- "${still[@]}" ;;
    esac
}

start_slurm() {
    needs slurmctld=slurmctld slurmd=slurmd sbatch=slurm-client munged=munge
    say "starting Slurm $(slurmctld -V | cut -d' ' -f2)"
    mkdir -p "$work"/{munge,slurm/state,slurm/spool}
    dd if=/dev/urandom of="$work/munge/key" bs=1024 count=1 status=none
    chmod 400 "$work/munge/key"
    chmod 711 "$work/munge"
    cat >"$work/slurm/slurm.conf" <<CONF
ClusterName=proof
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmUser=root
SlurmctldPort=26817
SlurmdPort=26818
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
StateSaveLocation=$work/slurm/state
SlurmdSpoolDir=$work/slurm/spool
SlurmctldPidFile=$work/slurm/slurmctld.pid
SlurmdPidFile=$work/slurm/slurmd.pid
SlurmctldLogFile=$work/slurm/slurmctld.log
SlurmdLogFile=$work/slurm/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
ReturnToService=2
MinJobAge=86400
NodeName=$(hostname -s) NodeAddr=127.0.0.1 CPUs=$(nproc) RealMemory=1024 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
    export SLURM_CONF=$work/slurm/slurm.conf
    munged --foreground --force --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
        --seed-file="$work/munge/seed" --log-file="$work/munge/log" 2>"$work/munge/talk" &
    await 20 test -S "$work/munge/socket"
    slurmctld -D 2>"$work/slurm/slurmctld.talk" &
    slurmd -D 2>"$work/slurm/slurmd.talk" &
    await 60 node_is_idle
}
node_is_idle() { sinfo -h -o %T 2>/dev/null | grep -qx idle; }

# The value of a key of a job.
of_job() { scontrol show job "$1" | tr ' ' '\n' | sed -n "s/^$2=//p" | head -1; }
is() { [ "$(of_job "$1" "$2")" = "$3" ]; }
ended() { case $(of_job "$1" JobState) in PENDING | RUNNING | COMPLETING | REQUEUED) false ;; esac; }

# submit SCRIPT: sets tasks and last.
submit() {
    local told
    told=$(bash "$1")
    echo "$told"
    tasks=$(sed 's/^tasks \([0-9]*\),.*/\1/' <<<"$told")
    last=$(sed 's/.*last one \([0-9]*\);.*/\1/' <<<"$told")
}

prove_slurm() {
    local what
    start_slurm
    for what in frames still; do
        say "Slurm, $what"
        job slurm $what "slurm $what" >"slurm_$what.sh"
        submit "slurm_$what.sh"
        await 120 is "${tasks}_2" JobState RUNNING
        sleep 1.5
        scancel --signal=TERM "${tasks}_2"
        await 60 is "${tasks}_2" Restarts 1
        echo "task 2 was stopped and is queued again"
        # Not in two minutes, as Slurm would have it.
        await 60 scontrol update JobId="${tasks}_2" StartTime=now 2>/dev/null
        await 300 ended "$last"
        is "$last" JobState COMPLETED || fail "the last task: $(of_job "$last" JobState)"
        is "${tasks}_2" Restarts 1 || fail "task 2 was started $(of_job "${tasks}_2" Restarts) times again"
        same_$what "slurm $what"
    done
    say "Slurm, a scene that went bad"
    cp scenes/materials.ron scenes/bad.ron
    "$luxel" farm slurm scenes/bad.ron --out "slurm bad" --shards 2 --cpus 1 --memory 256M >slurm_bad.sh
    echo "Scene(" >scenes/bad.ron
    submit slurm_bad.sh
    await 120 ended "$last"
    is "${tasks}_0" ExitCode 65:0 || fail "exit code $(of_job "${tasks}_0" ExitCode), not 65"
    is "${tasks}_0" Restarts 0 || fail "a bad scene was queued again"
    is "$last" JobState FAILED || fail "merged from nothing"
    echo "failed with 65, once"
}

# Stops the luxel that renders share 2 of 4 into a folder, as soon as it works.
stop_share_2() {
    local pid
    share_2() { pid=$(pgrep -f -- "^$luxel .*/$1/.*--shard 2/4" | head -1); }
    await 120 share_2 "$1"
    sleep 1.5
    kill -TERM "$pid" && echo "task 2 was stopped"
}

prove_openjd() {
    local what
    needs python3=python3 pgrep=procps
    say "OpenJD"
    python3 -m venv "$work/python" || { apt-get install -y -qq python3-venv >/dev/null && python3 -m venv "$work/python"; }
    "$work/python/bin/pip" install -q openjd-cli
    for what in frames still; do
        job openjd $what "openjd $what" >"openjd_$what.json"
        "$work/python/bin/openjd" check "openjd_$what.json"
        "$work/python/bin/openjd" run "openjd_$what.json" >"openjd_$what.log" 2>&1 &
        local run=$!
        stop_share_2 "openjd $what"
        wait $run && fail "a task was stopped, and the run succeeded"
        "$work/python/bin/openjd" run "openjd_$what.json" >"openjd_$what.again.log" 2>&1 || fail "the second run"
        grep -q "openjd_progress: 100" "openjd_$what.again.log" || fail "no progress was told"
        same_$what "openjd $what"
    done
}

prove_parallel() {
    local what
    needs parallel=parallel pgrep=procps
    for what in frames still; do
        say "GNU parallel, $what"
        job parallel $what "parallel $what" >"parallel_$what.sh"
        bash "parallel_$what.sh" >"parallel_$what.log" 2>&1 &
        local run=$!
        stop_share_2 "parallel $what"
        wait $run || fail "the run"
        same_$what "parallel $what"
    done
}

references
for engine in "${@:-slurm openjd parallel}"; do
    for one in $engine; do
        "prove_$one"
    done
done
say "proven"
