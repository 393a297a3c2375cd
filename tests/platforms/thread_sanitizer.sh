#!/usr/bin/env bash
# ThreadSanitizer over what runs in parallel: the program on scenes of every kind, and the tests of the tracer, the
# loaders, bands, sweeps and the window's thread. On two cores an hour to build, and half an hour to run.
#
#   tests/platforms/thread_sanitizer.sh
#
# The sanitizer knows only of the synchronization that is compiled with it. oneTBB's scheduler is a library that is
# not, so that every parallel loop would be a finding: the script compiles the release's own source of it (apt-get
# source; needs dpkg-dev and a network) into build/tsan/onetbb. Drivers are not compiled with it either: what they do
# among themselves is left out (thread_sanitizer.supp).
set -euo pipefail
cd -- "$(dirname -- "$(readlink -f -- "${BASH_SOURCE[0]}")")/../.."

build=$PWD/build/tsan
onetbb=$build/onetbb
programs=(raytrace_test raytrace_wide_test raytrace_accel_test hybrid_test scene_files_test compare_bands_gl_test
  sweep_test sweep_engine_gl_test shimmer_gl_test view_thread_gl_test)
scenes=(courtyard fence whitted penumbra studio shapes)
# Of these only what runs in parallel: the rest asks single rays one after the other, for hours.
declare -A parallel=(
  [raytrace_accel_test]='Accel.SameForAnyNumberOfThreads:Accel.VerdictsAndPicturesDoNotDependOnTheStructure:Accel.TexelListsAreTheSameBesideAnyStructure'
  [hybrid_test]='TexelParts*:HybridSolids*:HybridSoftShadows*:HybridCosts*'
  [sweep_engine_gl_test]='Engine.CellsEqualSingleComparisons:CellPictures*:ShadowCost*'
)

# The sources of the lists that apt reads, beside its own state.
fetch_onetbb() {
  local lists=$onetbb/apt
  mkdir -p "$lists/state/partial" "$lists/parts"
  chmod 755 "$onetbb" "$lists"
  sed 's/^Types:.*/Types: deb-src/' /etc/apt/sources.list.d/*.sources >"$lists/parts/sources.sources" 2>/dev/null || true
  sed -n 's/^deb /deb-src /p' /etc/apt/sources.list /etc/apt/sources.list.d/*.list >"$lists/parts/sources.list" 2>/dev/null || true
  local options=(-qq -o Dir::Etc::SourceList=/dev/null -o "Dir::Etc::SourceParts=$lists/parts"
    -o "Dir::State::Lists=$lists/state")
  apt-get "${options[@]}" update
  (cd "$onetbb" && apt-get "${options[@]}" source libtbb-dev)
}

if [[ ! -e $onetbb/installed ]]; then
  mkdir -p "$onetbb"
  compgen -G "$onetbb/onetbb-*/" >/dev/null || fetch_onetbb
  cmake -G Ninja -S "$onetbb"/onetbb-*/ -B "$onetbb/build" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTBB_TEST=OFF -DTBB_STRICT=OFF \
    -DTBB_SANITIZE=thread -DTBBMALLOC_BUILD=OFF -DCMAKE_INSTALL_PREFIX="$onetbb/installed.new"
  ninja -C "$onetbb/build" install
  mv "$onetbb/installed.new" "$onetbb/installed"
fi

# Everything is linked with the release's oneTBB, which Embree wants as well, and run with this one.
cmake --preset tsan
ninja -C "$build" app/gnomon "${programs[@]}"

export LD_LIBRARY_PATH=$onetbb/installed/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}
export TSAN_OPTIONS="halt_on_error=0 exitcode=66 ignore_noninstrumented_modules=1 suppressions=$PWD/tests/platforms/thread_sanitizer.supp"
failed=0
for scene in "${scenes[@]}"; do
  "$build/app/gnomon" compare "$scene" --size 320x180 -o "$build/out/$scene" --quiet || { echo "compare $scene: exit $?"; failed=1; }
done
for program in "${programs[@]}"; do  # not through ctest, whose limits of time are for programs without a sanitizer
  "$build/tests/$program" --gtest_brief=1 --gtest_filter="${parallel[$program]-*}" || { echo "$program: exit $?"; failed=1; }
done
exit "$failed"
