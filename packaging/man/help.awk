# Converts the output of --help (CLI11) to the source of a man page. Options and subcommands become tagged
# paragraphs; all other lines become text.
function roff(text) {
  gsub(/\\/, "\\e", text)
  gsub(/-/, "\\-", text)
  sub(/^\./, "\\\\\\&.", text)
  sub(/^'/, "\\\\\\&'", text)
  return text
}
NR == 1 || /^Usage:/ {next}
/^[A-Z][A-Za-z ]*:$/ {
  if ($0 != "Options:") print ".SS \"" substr($0, 1, length($0) - 1) "\""
  listed = 1
  next
}
listed && /^  [^ ]/ {
  line = substr($0, 3)
  split_at = match(line, /  +/)
  tag = split_at ? substr(line, 1, split_at - 1) : line
  text = split_at ? substr(line, split_at + RLENGTH) : ""
  print ".TP\n.B \"" roff(tag) "\""
  if (text != "") print roff(text)
  next
}
listed && /^   / {sub(/^ +/, ""); print roff($0); next}
/^$/ {if (listed) print ".PP"; listed = 0; next}
{print roff($0)}
