#!/bin/sh
# SPDX-FileCopyrightText: 2026 Taut contributors
# SPDX-License-Identifier: MIT

# bench/cape_table.sh CAPE_TABLE [SECONDS]: cape_table with rows of Jolt Physics, which runs in node, and what
# MuJoCo takes for a part of it. Installs jolt-physics from npm into build/jolt and mujoco from PyPI into
# build/mujoco. Debian: nodejs npm python3-venv.
set -eu
if [ $# -lt 1 ]; then
    echo "bench/cape_table.sh CAPE_TABLE [SECONDS]" >&2
    exit 2
fi
program=$(realpath "$1")
cd "$(dirname "$0")/.."
into=build/jolt
mkdir -p $into
npm install --silent --no-audit --no-fund --prefix $into jolt-physics@1.1.0
set -- "$program" "${2:-60}"
for each in "1 5" "4 10" "8 15"; do
    set -- "$@" "Jolt soft body (WebAssembly in node): ${each% *} × ${each#* } iterations" \
        "node bench/jolt/cape.mjs $into/node_modules/jolt-physics $each"
done
"$@"
python3 -m venv build/mujoco
build/mujoco/bin/pip install --quiet --disable-pip-version-check mujoco==4.0.0
cd build/mujoco  # where it writes its log
exec bin/python ../../bench/mujoco_sheet.py
