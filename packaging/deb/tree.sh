# Functions for other scripts. They build a Debian package from a folder tree.

# packed TREE NAME ARCHITECTURE  builds a package from TREE and prints its path. Before that, it adds the
# copyright, the changelog, the overrides, the control file (from NAME.control) and the checksums. The calling
# script sets $source, $changelog, $version and $out.
packed() {
  local tree=$1 name=$2 architecture=$3
  local doc=$tree/usr/share/doc/$name package=$out/${name}_${version}_$architecture.deb
  install -d "$tree/DEBIAN" "$doc" "$tree/usr/share/lintian/overrides"
  install -m 644 "$source/packaging/deb/copyright" "$doc/copyright"
  gunzip -c "$changelog" | sed "1s/^softgrip/$name/" | gzip -9n >"$doc/changelog.Debian.gz"
  sed "s/^softgrip:/$name:/" "$source/packaging/deb/lintian-overrides" >"$tree/usr/share/lintian/overrides/$name"
  sed -e "s/@VERSION@/$version/" -e "s/@ARCHITECTURE@/$architecture/" -e "s/@LIBRARIES@/${libraries:-}/" \
    "$source/packaging/deb/$name.control" >"$tree/DEBIAN/control"
  (cd "$tree" && find usr -type f -print0 | sort -z | xargs -0 md5sum >DEBIAN/md5sums)
  chmod -R u=rwX,go=rX "$tree"
  dpkg-deb --root-owner-group --build "$tree" "$package" >&2
  echo "$package"
}

# libraries_of FILE [FOLDER]  prints the packages on which a package that contains FILE depends. FOLDER contains
# additional libraries that FILE needs.
libraries_of() {
  local file folder=${2:+$(realpath "$2")} work
  file=$(realpath "$1")
  work=$(mktemp -d)
  mkdir "$work/debian"
  printf 'Source: softgrip\n\nPackage: softgrip\nArchitecture: any\n' >"$work/debian/control"
  (cd "$work" && dpkg-shlibdeps -O ${folder:+-l"$folder"} --ignore-missing-info "$file" 2>/dev/null) |
    sed -n 's/^shlibs:Depends=//p'
  rm -r "$work"
}
