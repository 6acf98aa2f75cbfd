#!/bin/bash
# nodus with a law of a plug-in: the tables are those of its own law, on one and on two ranks, from both file formats, from
# another working folder; the plug-in is named twice, in the reference, checked, and its values are part of a checkpoint.
# Usage: command_line.sh <nodus> <folder of block.prm and the plug-in> <empty folder> <mpirun -np> <numdiff>
set -u
nodus=$1 cases=$2 folder=$3 mpirun=$4 numdiff=$5
rm -rf "$folder" && mkdir -p "$folder" && cd "$folder" || exit 1

fail()
{
  echo "FAILED: $*"
  exit 1
}

run() # <results folder> further arguments
{
  local results=$1
  shift
  $ranks "$nodus" "$prm" --set "Output/Results folder=$results" --set "Output/Write VTU=false" \
    --set "Newton/Force tolerance=1e-12" "$@" > "$results.log" 2> "$results.message"
}
ranks= prm=$cases/block.prm

same() # <results folder> <another>
{
  for table in contact.csv reactions.csv energy.csv; do
    $numdiff -q -s ' \t\n,' -r 1e-8 -a 1e-9 "$1/$table" "$2/$table" > /dev/null || fail "$2/$table is not that of $1"
  done
}

# nodus's own law with the same constants: E = 9KG/(3K+G), nu = (3K-2G)/(6K+2G)
sed -e '/^ *set Additional/d' -e '/subsection Kirchhoff/,/end/d' \
  -e "s/set Law = .*/set Law = St Venant-Kirchhoff\n    set Young's modulus = 10.285714285714286\n    set Poisson's ratio = 0.28571428571428570/" \
  "$cases/block.prm" > shipped.prm
prm=shipped.prm
run shipped || fail "the shipped law: $(cat shipped.message)"
prm=$cases/block.prm
run own --set "Additional shared libraries=libkirchhoff.so, ./libkirchhoff.so" || fail "the law of the plug-in: $(cat own.message)"
same shipped own
ranks="$mpirun 2"
run own2 || fail "two ranks: $(cat own2.message)"
ranks=
same shipped own2

python3 - "$cases" > own.json <<'END'
import json, sys
print(json.dumps({
    "Additional shared libraries": [sys.argv[1] + "/libkirchhoff.so"],
    "Body 1": {"Generator": "subdivided_hyper_rectangle", "Generator arguments": "2,2,2 : 0,0,0 : 1,1,1 : true",
               "Name": "block",
               "Material": {"Law": "Kirchhoff with constants", "Young's modulus": 72 / 7, "Poisson's ratio": 2 / 7}},
    "Boundary condition 1": {"Name": "stamp", "Body": 1, "Boundary ids": [5], "Components": ["x", "y", "z"],
                             "Value": ["0.05*t", "0", "-0.1*t"]},
    "Contact pair 1": {"Slave body": 1, "Slave boundary ids": [4], "Master surface": "plane", "Master axis": [0, 0, 1],
                       "Friction coefficient": 0.3},
    "Load stepping": {"Increments": 4}}))
END
prm=own.json
run json || fail "JSON: $(cat json.message)"
same shipped json
prm=$cases/block.prm

"$nodus" "$prm" --document | grep -q '^| Bulk modulus | 0 | a number | Bulk modulus \[pressure\], \\> 0. |$' || fail "--document"
"$nodus" --document | grep -q "Bulk modulus" && fail "--document without the plug-in has its keys"
"$nodus" "$prm" --check-law > law.log || fail "--check-law: $(cat law.log)"
grep -q "^Body 1 (block): Kirchhoff with moduli$" law.log || fail "--check-law: $(cat law.log)"

# the state of a run belongs to the values of the law that is chosen, and to no other law
run parts --set "Output/Checkpoint interval=3" || fail "a run with checkpoints"
run parts --restart --set "Body 1/Material/Kirchhoff with moduli/Bulk modulus=9" && fail "restart with another value"
grep -q "'Body 1/Material/Kirchhoff with moduli/Bulk modulus' was '8' and is '9' now" parts.message || fail "$(cat parts.message)"
run parts --restart --set "Additional shared libraries=libkirchhoff.so, libanother.so" || fail "restart: $(cat parts.message)"
grep -q "^Continues after increment " parts.log || fail "it began anew"
same shipped parts
echo "all as it should be"
