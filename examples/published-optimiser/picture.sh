#!/bin/sh
# Makes docs/published-optimiser.png. Needs: pip install casadi; npm ci --prefix tests/browser; chromium; run it in the
# root of the repository.
set -eu
harness=${HARNESS:-target/release/harness}
out=$(mktemp -d)
trap 'rm -r "$out"' EXIT
# The verdict is a fail, which is exit code 1.
"$harness" run --name rendezvous-1 --planner-command 'python3 examples/published-optimiser/planner.py' \
    --record page --html --quiet --out "$out" || [ $? -eq 1 ]
node examples/published-optimiser/picture.mjs "$out/index.html" "$PWD/docs/published-optimiser.png"
