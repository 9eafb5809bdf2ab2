#!/usr/bin/env bash
# Installs the MCAP reader for tests/system/test_export.py in build/mcap with npm, with the versions and
# hashes of tests/system/mcap/package-lock.json. If the reader is already installed, no network is needed. If
# the computer can reach the packages of Debian but no npm registry, the script reports this and writes
# build/mcap/unreachable. The test then skips this reader. Any other failure is an error.
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."

pinned=tests/system/mcap folder=build/mcap
mkdir -p "$folder"
rm -f "$folder/unreachable"
if [ -d "$folder/node_modules/@mcap/core" ] && cmp -s "$pinned/package-lock.json" "$folder/package-lock.json"; then
  exit 0
fi
rm -rf "$folder/node_modules"
# node uses its own list of certificates. Some networks have a certificate authority of their own, which is installed in
# the certificates of the system. Therefore node must use the certificates of the system.
system_authorities=/etc/ssl/certs/ca-certificates.crt
[ ! -r $system_authorities ] || export NODE_EXTRA_CA_CERTS=${NODE_EXTRA_CA_CERTS:-$system_authorities}
cp "$pinned/package.json" "$pinned/package-lock.json" "$folder/"
if (cd "$folder" && npm ci --ignore-scripts --no-audit --no-fund --fetch-retries=1 --fetch-retry-mintimeout=1000 \
  --fetch-timeout=60000) >"$folder/npm.log" 2>&1; then
  exit 0
fi
rm -rf "$folder/node_modules" "$folder/package-lock.json"
code=$(sed -nE 's/^npm (ERR!|error) code ([A-Z_]+)$/\2/p' "$folder/npm.log" | head -n 1)
case $code in
  ENOTFOUND | EAI_AGAIN | ECONNREFUSED | ECONNRESET | ETIMEDOUT | ENETUNREACH | EHOSTUNREACH | ERR_SOCKET_TIMEOUT | \
    SELF_SIGNED_CERT_IN_CHAIN | UNABLE_TO_GET_ISSUER_CERT_LOCALLY | UNABLE_TO_VERIFY_LEAF_SIGNATURE)
    echo "npm reaches no registry ($code), so @mcap/core is not installed" >"$folder/unreachable"
    echo "NOT TESTED: MCAP files with the reader @mcap/core, because $(cat "$folder/unreachable")" >&2
    exit 0
    ;;
esac
tail -n 20 "$folder/npm.log" >&2
echo "mcap_reader.sh: npm did not install @mcap/core (complete output: $folder/npm.log)" >&2
exit 1
