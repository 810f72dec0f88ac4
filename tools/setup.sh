# Shared by ./run and ./check: installs what is missing, configures and builds. POSIX sh, to be sourced.
# The caller sets `top`, the folder of the sources.

say() { printf '%s\n' "atrito: $*" >&2; }

fail() {
   say "$*"
   exit 9
}

# The packages that Debian and Ubuntu lack for the build, by what they would provide.
missing_packages() {
   command -v gfortran >/dev/null 2>&1 || printf ' gfortran'
   command -v cc >/dev/null 2>&1 || printf ' gcc'
   command -v cmake >/dev/null 2>&1 || printf ' cmake'
   command -v make >/dev/null 2>&1 || printf ' make'
   found_library libopenblas.so || printf ' libopenblas-dev'
   found_hdf5 || printf ' libhdf5-dev'
}

# found_library FILE: a library that programs can be linked with.
found_library() {
   for folder in /usr/lib /usr/lib64 /usr/lib/*-linux-gnu /usr/local/lib; do
      [ -e "$folder/$1" ] && return 0
   done
   return 1
}

found_hdf5() {
   for folder in /usr/include/hdf5/serial /usr/include /usr/local/include; do
      [ -e "$folder/hdf5.mod" ] && return 0
   done
   return 1
}

found_metis() {
   for folder in /usr/include /usr/local/include; do
      [ -e "$folder/metis.h" ] && return 0
   done
   return 1
}

# Installs what is missing; nothing to do is nothing said, and no network is needed then.
install_missing() {
   packages=$(missing_packages)
   command -v gnuplot >/dev/null 2>&1 || want gnuplot-nox "without gnuplot --plot writes its scripts, but no pictures"
   found_library libdmumps_seq.so || want libmumps-seq-dev "without MUMPS there is no limit program (tests/bench)"
   found_library libClp.so || want coinor-libclp-dev "without Clp it is not proved that a scene has no equilibrium: such runs end with 3 in place of 4"
   found_metis || want libmetis-dev "without METIS large graded meshes take longer"
   [ -z "$packages" ] || install_packages "$packages"
}

# What the tests of label peers run beside: CalculiX and its test decks, which some systems leave out as documentation.
install_peers() {
   packages=
   command -v ccx >/dev/null 2>&1 || want calculix-ccx "without ccx decks are compared with stored results of CalculiX alone"
   [ -d /usr/share/doc/calculix-ccx-test/examples/test ] ||
      want calculix-ccx-test "without the test decks of CalculiX docs/user/compatibility.md is not checked"
}

# want PACKAGE LOSS: what atrito can do without comes along with the other packages, else it is tried once, and without it the
# build goes on.
want() {
   if [ -n "$packages" ]; then
      packages="$packages $1"
   elif [ ! -e "$top/build/$1-tried" ]; then
      mkdir -p "$top/build"
      : >"$top/build/$1-tried"
      (install_packages " $1") || say "$2"
   fi
}

install_packages() {
   packages=$1
   as_root=
   if [ "$(id -u)" -ne 0 ]; then
      command -v sudo >/dev/null 2>&1 || fail "please install$packages (no sudo here)"
      as_root=sudo
   fi
   command -v apt-get >/dev/null 2>&1 || fail "please install$packages (no apt-get here)"
   say "installing$packages"
   mkdir -p "$top/build"
   log=$top/build/install.log
   if ! { $as_root apt-get update && $as_root env DEBIAN_FRONTEND=noninteractive \
      apt-get install -y --no-install-recommends -o "Dpkg::Options::=--path-include=/usr/share/doc/calculix-ccx-test/*" $packages; } >"$log" 2>&1; then
      tail -n 20 "$log" >&2
      fail "could not install$packages; the whole output is in $log"
   fi
}

# The presets need CMake 3.25; an older one would only say that it cannot read them.
need_cmake() {
   version=$(cmake --version | sed -n 's/^cmake version \([0-9]*\)\.\([0-9]*\).*/\1 \2/p')
   major=${version% *}
   minor=${version#* }
   [ "${major:-0}" -gt 3 ] || { [ "${major:-0}" -eq 3 ] && [ "${minor:-0}" -ge 25 ]; } ||
      fail "CMake 3.25 or later is needed, and $(command -v cmake) is $(cmake --version | sed -n '1s/.* //p')"
}

# A build folder that was moved or copied with its sources still builds the old ones.
forget_moved_build() {
   [ -f "$1/CMakeCache.txt" ] || return 0
   grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$top" "$1/CMakeCache.txt" && return 0
   say "$1 belongs to other sources; it is made anew"
   rm -rf "$1"
}

# build_preset NAME [OPTION=ON|OFF]: configures build/NAME where that was not done, or for other presets, or with another value of the
# option, and builds what has changed.
build_preset() {
   preset=$1
   option=${2:-}
   log=$top/build/$preset.log
   mkdir -p "$top/build"
   forget_moved_build "$top/build/$preset"
   if [ ! -f "$top/build/$preset/CMakeCache.txt" ] || [ ! -f "$top/build/$preset/Makefile" ] ||
      [ -n "$(find "$top/CMakePresets.json" -newer "$top/build/$preset/CMakeCache.txt" 2>/dev/null)" ] ||
      { [ -n "$option" ] && ! grep -qxF "${option%=*}:BOOL=${option#*=}" "$top/build/$preset/CMakeCache.txt"; }; then
      need_cmake
      say "configuring build/$preset"
      (cd "$top" && cmake --preset "$preset" ${option:+"-D$option"}) >"$log" 2>&1 || show_log "configuring failed"
      say "building (about a minute)"
   fi
   (cd "$top" && cmake --build "build/$preset" -j "$(nproc 2>/dev/null || echo 2)") >>"$log" 2>&1 ||
      show_log "building failed"
}

show_log() {
   tail -n 30 "$log" >&2
   fail "$1; the whole output is in $log"
}
