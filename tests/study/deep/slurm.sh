#!/usr/bin/env bash
# A study by Slurm itself, on this machine alone: its daemons run here, for as long as this does, with a folder, ports and a key
# of their own. A job array of processes that --join and one of --shard slurm, of each of which a running task is queued
# again, must make the file of one process. Needs root and the Debian packages slurm-wlm and munge.
#
#     ASDIC=build/ci/bin/asdic tests/study/deep/slurm.sh
set -euo pipefail
asdic=$(realpath "$ASDIC")
root=$(realpath "$(dirname "$0")/../../..")
for tool in slurmctld slurmd munged sbatch scontrol; do
  if ! PATH=$PATH:/usr/sbin command -v "$tool" >/dev/null; then
    echo "no $tool (slurm-wlm, munge): left out"
    exit 77
  fi
done
PATH=$PATH:/usr/sbin
folder=$(mktemp -d)
daemons=()
# shellcheck disable=SC2317
leave() {
  for daemon in "${daemons[@]}"; do kill "$daemon" 2>/dev/null || true; done
  wait 2>/dev/null || true
  rm -rf "$folder"
}
trap leave EXIT
fail() {
  echo "slurm.sh: $*"
  tail -n 5 "$folder"/*.log 2>/dev/null || true
  exit 1
}

host=$(hostname -s)
export SLURM_CONF=$folder/slurm.conf
cat >"$SLURM_CONF" <<CONF
ClusterName=asdic
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
SlurmctldPort=26817
SlurmdPort=26818
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket,cred_expire=5
CryptoType=crypto/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
JobRequeue=1
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=8 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
mkdir "$folder/state" "$folder/spool" "$folder/work"
head -c 1024 /dev/urandom >"$folder/munge.key"
chmod 600 "$folder/munge.key"
chmod 755 "$folder"
munged --foreground --force --key-file="$folder/munge.key" --socket="$folder/munge.socket" \
  --pid-file="$folder/munge.pid" --log-file="$folder/munged.log" --seed-file="$folder/munge.seed" >/dev/null 2>&1 &
daemons+=($!)
for ((i = 0; i < 100; ++i)); do [ -S "$folder/munge.socket" ] && break; sleep 0.1; done
slurmctld -D >"$folder/slurmctld.log" 2>&1 &
daemons+=($!)
slurmd -D -N "$host" >"$folder/slurmd.log" 2>&1 &
daemons+=($!)
for ((i = 0; i < 100; ++i)); do
  [ "$(sinfo -h -o %t 2>/dev/null)" = idle ] && break
  sleep 0.3
done
[ "$(sinfo -h -o %t)" = idle ] || fail "the node is $(sinfo -h -o %t), not idle"

cd "$folder/work"
cp "$root/scenarios/studies/known_answer.toml" study.toml
sed -i 's/^realisations = .*/realisations = 60000/' study.toml
"$asdic" study study.toml -o one.h5 --quiet
mkdir parts
for way in join shard; do
  if [ $way = join ]; then
    line="\"$asdic\" study study.toml --join --silence 5 --threads 1 -o join.h5"
  else
    line="\"$asdic\" study study.toml --shard slurm --threads 1 -o \"parts/\$SLURM_ARRAY_TASK_ID.h5\""
  fi
  printf '#!/bin/bash\n#SBATCH --array=1-4\n#SBATCH --cpus-per-task=1\n#SBATCH --requeue\ncd "$SLURM_SUBMIT_DIR"\n%s\n' \
    "$line" >"$way.sbatch"
  job=$(sbatch --parsable "$way.sbatch")
  requeued=no
  for ((i = 0; i < 600; ++i)); do
    if [ $requeued = no ] && [ "$(squeue -h -j "${job}_2" -t RUNNING | wc -l)" = 1 ]; then
      sleep 0.5
      scontrol requeue "${job}_2" 2>/dev/null && requeued=yes
    fi
    [ "$(squeue -h -j "$job" 2>/dev/null | wc -l)" = 0 ] && break
    sleep 0.3
  done
  [ "$(squeue -h -j "$job" 2>/dev/null | wc -l)" = 0 ] || fail "$way: $(squeue)"
  [ $requeued = yes ] || fail "$way: no task was running long enough to be queued again"
done
"$asdic" merge parts/*.h5 -o shard.h5 --copy >/dev/null
for made in join shard; do
  /usr/bin/python3 - one.h5 $made.h5 <<'PY' || fail "$made.h5 is not the file of one process"
import sys
import h5py
one, other = ({} for _ in range(2))
for path, found in zip(sys.argv[1:], (one, other)):
    with h5py.File(path) as file:
        def note(name, thing):
            if isinstance(thing, h5py.Dataset) and not name.startswith("run") and name != "manifest":
                found[name] = thing[()].tobytes() if thing.shape else thing[()]
        file.visititems(note)
        assert file.attrs["complete"] == 1
different = [name for name in one.keys() | other.keys() if one.get(name) != other.get(name)]
print(different) if different else None
sys.exit(bool(different))
PY
done
echo "Slurm $(sinfo --version | cut -d' ' -f2): 60000 realisations by --join and by --shard slurm, a task of each queued again: the same bits"
