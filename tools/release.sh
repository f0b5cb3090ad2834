#!/bin/sh
# What a release consists of: tools/release.sh OUT
# Checks that the work tree is clean, that the versions of the crate, of the Python package and of CITATION.cff are one, and that the
# changelog has a section of it; then makes in OUT the crate, which is compiled as it is packed, the wheel, the program, on Linux also as
# one static file, and a file of SHA-256 sums. It publishes nothing. Needs the Rust toolchain, git, and Python with maturin
# (pip install "maturin<2", and ziglang for a wheel that older systems take); for the static program the target of musl
# (rustup target add x86_64-unknown-linux-musl) and musl-gcc (Debian: musl-tools): it says so where they are not.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/.." && pwd)
fail() {
    echo "release: $*" >&2
    exit 1
}
[ $# -eq 1 ] || { echo "usage: tools/release.sh OUT" >&2; exit 2; }
cd "$root"
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
[ "$(sed -n 's/^version = "\(.*\)"/\1/p' python/Cargo.toml | head -1)" = "$version" ] || fail "python/Cargo.toml is not of version $version"
grep -qx "version: $version" CITATION.cff || fail "CITATION.cff is not of version $version"
grep -qF "## [$version]" CHANGELOG.md || fail "CHANGELOG.md has no section [$version]"
[ -z "$(git status --porcelain)" ] || fail "the work tree is not clean"
target=${CARGO_TARGET_DIR:-$root/target}
mkdir -p "$1"
out=$(cd "$1" && pwd)
cargo package --locked
cp "$target/package/spinneb-$version.crate" "$out"
# without the names that a debugger reads
export CARGO_PROFILE_DIST_STRIP=true
host=$(rustc -vV | sed -n 's/^host: //p')
cargo build --profile dist --locked
cp "$target/dist/spinneb" "$out/spinneb-$version-$host"
static=${host%-gnu}-musl
case $host in
*-linux-gnu)
    if [ ! -d "$(rustc --print target-libdir --target "$static")" ]; then
        echo "release: no static program: rustup target add $static" >&2
    elif ! command -v musl-gcc >/dev/null; then
        echo "release: no static program: there is no musl-gcc" >&2
    else
        cargo build --profile dist --locked --target "$static"
        cp "$target/$static/dist/spinneb" "$out/spinneb-$version-$static"
    fi
    ;;
esac
# linked by zig, where its package is there (pip install ziglang), the wheel runs on every Linux with glibc 2.17 or later
zig=
! python3 -m ziglang version >/dev/null 2>&1 || [ "$(uname -s)" != Linux ] || zig="--zig --compatibility manylinux2014"
# shellcheck disable=SC2086
(cd python && maturin build --profile wheel --locked $zig --out "$out")
for wheel in "$out"/*.whl; do
    [ "$(wc -c <"$wheel")" -lt 5000000 ] || fail "$wheel is larger than 5 MB"
done
(cd "$out" && find . -maxdepth 1 -type f -name '*spinneb*' ! -name SHA256SUMS | sort | xargs sha256sum >SHA256SUMS)
echo "release: version $version is in $out; to publish it:"
echo "  git tag v$version, cargo publish, and an upload of the wheel and of these files"
