# Bash completion for `fathom`. It reads subcommands and options from the program's own --help. The test `install` compares the words
# listed here, of devices and sources, with the help.

# Prints the long options of a help text, and the names below "Subcommands:".
_fathom_words() {
    "$@" --help 2>/dev/null | awk '
        /^Subcommands:/ { names = 1; next }
        /^[A-Z]/ { names = 0 }
        names && /^  [a-z]/ { if (sub(/,$/, "", $1)) print $2; print $1 }
        match($0, /^  (-[a-z],)?--[a-z][a-z0-9-]*/) { word = substr($0, RSTART, RLENGTH); sub(/^ +(-[a-z],)?/, "", word); print word }'
}

_fathom() {
    local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command="" i
    COMPREPLY=()
    for ((i = 1; i < COMP_CWORD; i++)); do
        case ${COMP_WORDS[i]} in
        --device | --trace) i=$((i + 1)) ;;
        -*) ;;
        *) command=${COMP_WORDS[i]}; break ;;
        esac
    done
    case $before in
    --query) mapfile -t COMPREPLY < <(compgen -W "cpu gpu" -- "$current"); return ;;
    --hand-device) mapfile -t COMPREPLY < <(compgen -W "falcon haply ros2 spacemouse" -f -- "$current"); return ;;
    --source) mapfile -t COMPREPLY < <(compgen -W "v4l2:auto openni2 ros2:depth=" -f -- "$current"); return ;;
    esac
    if [[ $current == -* ]] || [[ -z $command && $before != --trace && $before != --device ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_fathom_words "${COMP_WORDS[0]}" ${command:+"$command"}) $([[ -n $command ]] && _fathom_words "${COMP_WORDS[0]}" | grep ^--)" -- "$current")
        return
    fi
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
}
complete -o filenames -F _fathom fathom
