#!/bin/sh
# Builds libsolid and installs it: libsolid.so, libsolid.a, the headers, a pkg-config file and a CMake package.
#
#     crates/solid-capi/install.sh PREFIX            (DESTDIR is put before PREFIX, as make install does)
#     crates/solid-capi/install.sh PREFIX FOLDER     the same with the libraries that are built already in FOLDER
#
# What is installed may be moved as a whole. Needs cargo, unless FOLDER is given; GNU ld and objcopy if they are there.
set -eu

usage() { sed -n '2,7s/^# \{0,1\}//p' "$0"; }
case ${1:-} in
    -h | --help) usage; exit ;;
    -*) usage >&2; exit 2 ;;
esac
[ $# -ge 1 ] && [ $# -le 2 ] || { usage >&2; exit 2; }
here=$(cd "$(dirname "$0")" && pwd)
prefix=${DESTDIR:-}$1
version=$(sed -n '/^\[workspace.package\]/,/^$/s/^version = "\(.*\)"/\1/p' "$here/../../Cargo.toml")

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

if [ $# -eq 2 ]; then
    built=$2
else
    target=${CARGO_TARGET_DIR:-$here/../../target}
    case $target in
        /*) ;;
        *) target=$PWD/$target ;;
    esac
    # Cargo tells where the libraries are: for a target that is configured they have a folder of their own.
    (cd "$here/../.." && cargo build --release -p solid-capi --target-dir "$target" \
        --message-format json-render-diagnostics >"$scratch/messages")
    built=$(sed -n 's/.*"\([^"]*\)\/libsolid\.a".*/\1/p' "$scratch/messages")
fi

# Without its debug information the library is a tenth of the size.
cp "$built/libsolid.so" "$scratch/libsolid.so"
if command -v strip >/dev/null; then strip --strip-unneeded "$scratch/libsolid.so"; fi

# Rust's archive brings all of its standard library with it, under names that clash with those of any other such archive.
# One object that keeps what the functions need, and shows nothing but them, clashes with nobody.
functions=$(sed -n 's/^[A-Za-z].*[ *]\(dt[A-Za-z]*\)(.*/\1/p' "$here"/include/SOLID/solid.h "$here"/include/SOLID/error.h)
if command -v ld >/dev/null && command -v objcopy >/dev/null &&
    ld -r --gc-sections $(printf -- '-u %s ' $functions) "$built/libsolid.a" -o "$scratch/solid.o" 2>"$scratch/log" &&
    objcopy --strip-debug -R .llvmbc -R .llvmcmd --wildcard --keep-global-symbol='dt*' "$scratch/solid.o" 2>"$scratch/log"
then
    ar rcs "$scratch/libsolid.a" "$scratch/solid.o"
else
    echo "note: libsolid.a is installed as cargo made it, with all symbols of Rust's standard library" >&2
    cp "$built/libsolid.a" "$scratch/libsolid.a"
fi

mkdir -p "$prefix/lib/pkgconfig" "$prefix/lib/cmake/SOLID" "$prefix/include/SOLID" "$prefix/include/3D"
install -m 755 "$scratch/libsolid.so" "$prefix/lib/"
install -m 644 "$scratch/libsolid.a" "$prefix/lib/"
install -m 644 "$here"/include/SOLID/*.h "$prefix/include/SOLID/"
install -m 644 "$here"/include/3D/*.h "$prefix/include/3D/"
for template in "$here"/templates/*.in; do
    name=$(basename "$template" .in)
    sed "s/@VERSION@/$version/g" "$template" >"$scratch/$name"
    case $name in
        *.pc) install -m 644 "$scratch/$name" "$prefix/lib/pkgconfig/" ;;
        *.cmake) install -m 644 "$scratch/$name" "$prefix/lib/cmake/SOLID/" ;;
    esac
done
echo "libsolid $version is installed in $prefix"
