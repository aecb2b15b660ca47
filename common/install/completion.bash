# Completes the command lines of raster, raytrace and compare in bash. Options and subcommands are those that the
# program's --help prints; any other word is completed as a file name.
_duet() {
    local -a command=("$1")
    local words=''
    COMPREPLY=()
    # The help of raytrace mentions its subcommand merge in a text only.
    if ((COMP_CWORD > 1)) && [[ ${1##*/} == compare || ${COMP_WORDS[1]} == merge ]]; then
        command+=("${COMP_WORDS[1]}")
    fi
    if [[ $2 == -* ]]; then
        words=$("${command[@]}" --help 2>/dev/null | sed -n 's/^  \(-[^ ]*\).*/\1/p' | sed 's/{[a-z]*}//g; s/,/ /g')
    elif ((COMP_CWORD == 1)); then
        words=$("$1" --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
    fi
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$2")
}
complete -o default -F _duet raster raytrace compare
