#!/usr/bin/env bash
# Builds Box2D 3.2 and unpacks Debian's Siconos below the current folder, a clone; builds the benchmarks against them and runs them
# (docs/cost.md). Box2D 2.4 is Debian's libbox2d-dev.
set -euo pipefail
git clone https://github.com/erincatto/box2d
git -C box2d checkout 617d32ab
cmake -S box2d -B box2d/build -DCMAKE_BUILD_TYPE=Release -DBOX2D_AVX2=ON -DBOX2D_VALIDATE=OFF -DBOX2D_SAMPLES=OFF -DBOX2D_UNIT_TESTS=OFF -DCMAKE_INSTALL_PREFIX="$PWD/box2d3"
cmake --build box2d/build --target install
apt-get download libsiconos-numerics7 libsiconos-numerics-dev liblapacke libtmglib3 libmumps-seq-5.5
for package in *.deb; do dpkg -x "$package" siconos; done
cmake -S . -B build -DDRUMLIN_BOX2D3_ROOT="$PWD/box2d3" -DDRUMLIN_BOX2D3_REVISION=617d32ab -DDRUMLIN_SICONOS_ROOT="$PWD/siconos/usr"
cmake --build build --target benchmark_box2d benchmark_box2d3 benchmark_siconos benchmark_problem drumlin

scene=data/scenes/drum-6rpm.toml
build/drumlin run $scene -o RUN
build/benchmark_box2d $scene RUN/snapshots/000200.h5 results/box2d.json
build/benchmark_box2d3 $scene RUN/snapshots/000200.h5 results/box2d3.json
build/benchmark_box2d3 $scene RUN/snapshots/000200.h5 results/box2d3-stiff.json substeps=128 contact_hertz=16000 contact_speed=10000 length_unit=10 recycling=0 seconds=0.1 repeats=3
for n in 100 300; do build/benchmark_problem $scene RUN/snapshots/000200.h5 $n flow-$n.h5; done
export LD_LIBRARY_PATH=$PWD/siconos/usr/lib/x86_64-linux-gnu OPENBLAS_NUM_THREADS=1 SICONOS_VERSION=4.4.0
python3 tests/benchmarks/siconos.py build results/siconos.json 3 data/problems/drum-300-mu-0.4-{flow,settled}.h5={1e-2,1e-4} flow-{100,300}.h5={1e-2,3e-3} flow-100.h5=1e-3
