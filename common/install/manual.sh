#!/bin/sh
# Writes the manual page of a program, in man's format, from what its --help prints; subcommands follow as sections.
# usage: manual.sh PROGRAM VERSION > NAME.1
set -eu
program=$1
name=$(basename "$program")

# Writes the sections of one help text. Its first line is the description. A part begins with its name and a colon.
# Terms are indented by two columns, and their descriptions stand to the right or on the next line.
sections() {
    awk -v title="$1" '
        function text(s) {
            gsub(/\\/, "\\e", s)
            gsub(/-/, "\\-", s)
            return s ~ /^[.\x27]/ ? "\\&" s : s
        }
        function section(s) { print (title == "" ? ".SH \"" : ".SS \"") s "\"" }
        NR == 1 {
            if (title == "") { sub(/\.$/, ""); print text(name " - " tolower(substr($0, 1, 1)) substr($0, 2)) }
            else print ".SH " toupper(name " " title) "\n" text($0)
            next
        }
        /^Usage: / { section("SYNOPSIS"); print ".B " text(substr($0, 8)); next }
        /^([A-Z][a-z]+|Example.*):$/ { sub(/:/, ""); part = $0; section(toupper(part)); next }
        part ~ /^Example/ && /^  / { print ".PP\n.nf\n" text($0) "\n.fi"; next }
        /^  [^ ]/ {
            sub(/^  /, "")
            at = match($0, /  +/)
            if (substr($0, 28) ~ /^ [A-Z][a-z]* /) at = 28 # the column of descriptions, which a term may reach
            term = at ? substr($0, 1, at) : $0
            sub(/ +$/, "", term)
            sub(/{false}/, "", term) # says that a flag switches off
            print ".TP\n.B " text(term)
            if (!at) next
            $0 = substr($0, at)
        }
        /^ *$/ { next }
        /^[^ ]/ && part != "" && part !~ /^Example/ { print ".PP" }
        /^Exit codes: / { section("EXIT STATUS"); sub(/^Exit codes: /, ""); part = "" }
        { sub(/^ +/, ""); print text($0) }' name="$name"
}

echo ".TH $(echo "$name" | tr a-z A-Z) 1 \"\" \"Duet $2\" \"User Commands\""
echo '.SH NAME'
"$program" --help | sections ''
subcommands=$("$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
[ "$name" != raytrace ] || subcommands=merge # the help mentions it in a text
for subcommand in $subcommands; do
    "$program" "$subcommand" --help | sections "$subcommand"
done
