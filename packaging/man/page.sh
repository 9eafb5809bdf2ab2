#!/usr/bin/env bash
# Writes a gzipped man page from the --help of a program and from a page of the documentation:
#   page.sh VERSION DATE OUT.N.gz NAME SUMMARY [PROGRAM] REFERENCE.md
#   with PROGRAM      synopsis and options out of its --help, then the reference
#   without           the reference (a file format)
set -euo pipefail
version=$1 date=$2 out=$3 name=$4 summary=$5 reference=${!#}
program=
[ $# -lt 7 ] || program=$6
here=$(dirname "$(realpath "$0")")
section=${out%.gz} section=${section##*.}
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT

body() {
  pandoc -f markdown-smart-tex_math_dollars -t man --lua-filter="$here/plain.lua" "$1" |
    sed -e 's/\\f\[V\]/\\fB/g; s/\\f\[VB\]/\\fB/g; s/\\f\[[VB]I\]/\\fI/g; s/\\f\[C\]//g; s/\\f\[\([RBI]\)\]/\\f\1/g'
}

{
  printf "'\\\\\" t\n.TH %s %s %s \"softgrip %s\" \"softgrip\"\n" "${name^^}" "$section" "$date" "$version"
  printf '.SH NAME\n%s \\- %s\n' "${name//-/\\-}" "$summary"
  if [ -n "$program" ]; then
    COLUMNS=78 "$program" --help >"$work/help"
    printf '.SH SYNOPSIS\n.B %s\n[OPTIONS]\n.SH OPTIONS\n' "${name//-/\\-}"
    awk -f "$here/help.awk" "$work/help"
  fi
  printf '.SH DESCRIPTION\n'
  body "$reference"
} | awk '
  # Removes empty paragraphs before and after a heading.
  $0 == ".PP" {held = before !~ /^\.(SH|SS)/; next}
  {if (held && $0 !~ /^\.(SH|SS|TP)/) print ".PP"; held = 0; print; before = $0}' >"$work/page"
gzip -9n <"$work/page" >"$out"
