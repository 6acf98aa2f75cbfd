#!/bin/bash
# nodus as a process: ends on SIGTERM and continues to the same tables; two runs do not share a results folder, a run that
# begins anew keeps the checkpoints of the one before, and a folder that cannot be written in ends in one message. Usage: command_line.sh <nodus> <prm> <empty folder>
set -u
nodus=$1 prm=$2 folder=$3
rm -rf "$folder" && mkdir -p "$folder" && cd "$folder" || exit 1

fail()
{
  echo "FAILED: $*"
  exit 1
}

exits_with() # <expected exit code> <exit code> <of what>
{
  [ "$2" = "$1" ] || fail "$3: exit code $2 instead of $1"
}

run() # <results folder> further arguments
{
  local results=$1
  shift
  $in_place "$nodus" "$prm" --set "Output/Results folder=$results" --set "Load stepping/Increments=40,60" \
    --set "Output/VTU interval=20" "$@"
}
in_place=

run whole > whole.log || fail "the run that is not interrupted"

in_place=exec # signals are for nodus, not for a shell around it
run parts > parts.log 2> parts.message &
process=$!
in_place=
for _ in $(seq 600); do
  [ -f parts/contact.csv ] && [ "$(wc -l < parts/contact.csv)" -gt 5 ] && break
  sleep 0.05
done
kill -STOP $process || fail "it was over before the second run" # it waits, so that the second run cannot come too late
run parts > second.log 2> second.message
exits_with 1 $? "a second run in the folder"
grep -q "another run is writing to the results folder parts.*Output/Results folder" second.message || fail "$(cat second.message)"
kill -TERM $process && kill -CONT $process || fail "it was over before the signal"
wait $process
exits_with 143 $? "the run that was ended"
grep -q "^nodus: ended by SIGTERM in increment .*; --restart continues from t = " parts.message || fail "$(cat parts.message)"
run parts --restart > restart.log || fail "restart"
grep -q "^Continues after increment " restart.log || fail "it began anew"
for table in contact.csv reactions.csv energy.csv; do
  cmp whole/$table parts/$table || fail "$table differs"
done
diff <(grep DataSet whole/bodies.pvd) <(grep DataSet parts/bodies.pvd) || fail "bodies.pvd differs"

in_place=exec
run parts > anew.log & # a process of its own, to be ended
process=$!
in_place=
for _ in $(seq 600); do
  grep -q "^Increment 2" anew.log && break
  sleep 0.05
done
kill -TERM $process
wait $process
grep -q "^Checkpoints of an earlier run are kept in parts/checkpoints.before" anew.log || fail "$(cat anew.log)"
[ "$(ls parts/checkpoints.before | wc -l)" -gt 0 ] || fail "checkpoints.before is empty"

mkdir taken && touch taken/checkpoints
run taken > taken.log 2> taken.message
exits_with 1 $? "checkpoints is a file"
grep -q "taken/checkpoints is no folder" taken.message || fail "$(cat taken.message)"
[ "$(ls taken)" = checkpoints ] || fail "checkpoints is a file: left $(ls taken)"

# A folder where a file is to be written is found before anything is.
cp -r whole blocked && rm blocked/bodies.pvd && mkdir blocked/bodies.pvd
before=$(cd blocked && find . -type f -exec cksum {} + | sort)
run blocked --restart > blocked.log 2> blocked.message
exits_with 1 $? "bodies.pvd is a folder"
grep -q "blocked/bodies.pvd is a folder, but the run writes a file of this name: remove it" blocked.message ||
  fail "$(cat blocked.message)"
[ "$(cd blocked && find . -type f -exec cksum {} + | sort)" = "$before" ] || fail "bodies.pvd is a folder: files changed"

long=$(printf 'x%.0s' $(seq 300))
run "$long" > long.log 2> long.message
exits_with 1 $? "folder name too long"
grep -q "^nodus: input error: .*cannot create the results folder x*: File name too long.*Output/Results folder" long.message ||
  fail "$(cat long.message)"

run /proc/nodus > unwritable.log 2> unwritable.message
exits_with 1 $? "unwritable folder"
grep -q "cannot create the results folder /proc/nodus.*Output/Results folder" unwritable.message || fail "$(cat unwritable.message)"
echo "all as it should be"
