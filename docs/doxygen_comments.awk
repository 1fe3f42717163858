# Doxygen's INPUT_FILTER. Turns plain // comments into documentation and keeps the line numbers.
# - The comment at the head of a file documents the file. It also documents the type with the file's name (with
#   or without Pass), if that type has no comment of its own.
# - A comment above declarations documents those right below it, up to the next comment or empty line.
# - A comment behind a declaration, or behind a type's brace, documents that declaration or type.
# - A comment with nothing below it stays a plain comment.
function isComment(text) { return text ~ /^[ \t]*\/\// }
function plain(text) { sub(/^[ \t]*\/\/+ ?/, "", text); return escaped(text) }
function escaped(text) { gsub(/</, "\\<", text); return text } # so that it is no HTML tag
# The name of the type that belongs to this file: wrench_stage.h gives WrenchStage.
function typeName(    parts, n, i, name) {
    n = split(FILENAME, parts, "/")
    name = parts[n]
    sub(/[.]h$/, "", name)
    n = split(name, parts, "_")
    name = ""
    for (i = 1; i <= n; i++) name = name toupper(substr(parts[i], 1, 1)) substr(parts[i], 2)
    return name
}
# Prints the pending comment, as documentation or unchanged.
function release(documents,    i, line) {
    for (i = 1; i <= held; i++) {
        line = hold[i]
        if (documents) { match(line, /^ */); line = substr(line, 1, RLENGTH) "/// " plain(line) }
        print line
    }
    held = 0
}

FNR == 1 { inHead = 1; own = typeName() }
inHead && isComment($0) {
    if ($0 ~ /SPDX-License-Identifier/) { print "/// @file"; next }
    about = about plain($0) " "
    print "/// " plain($0)
    next
}
inHead { inHead = 0 }
isComment($0) {
    match($0, /\/\//)
    if (RSTART == trailing) { print substr($0, 1, RSTART - 1) "///< " plain($0); next } # continues the comment of the line above
    trailing = 0
    hold[++held] = $0
    next
}
{
    trailing = 0
    match($0, /^ */)
    indent = RLENGTH
    declares = $0 !~ /^[ \t]*($|[})#]|(public|private|protected):)/
    begins = declares && (ended || held) # a declaration, not a further line of one
    if (held) {
        shared = ""
        if (declares) for (i = 1; i <= held; i++) shared = shared plain(hold[i]) " "
        level = indent
        release(declares)
        above = declares
    } else if ($0 ~ /^[ \t]*$/) { shared = ""; above = 0 }
    else if (begins && shared != "" && indent == level) { $0 = "/** " shared "*/ " $0; above = 1 }
    else if (begins) above = 0
    ended = $0 ~ /(^|[;{}:])[ \t]*(\/\/.*)?$/
    if (match($0, /[^ \t\/] *\/\/ /) && declares) {
        at = RSTART + RLENGTH - 3
        code = substr($0, 1, at - 1)
        if (code ~ /[{] *$/) {
            if (!above && code ~ /^ *(template *<.*> *)?(class|struct|enum|union) /) $0 = "/** " escaped(substr($0, at + 3)) " */ " code
            above = 1
        } else { trailing = at; $0 = code "///< " escaped(substr($0, at + 3)) }
    }
    if (!above && !held && match($0, "^(template *<.*> *)?(class|struct) " own "(Pass)?( |$)")) $0 = "/** " about "*/ " $0
    print
}
END { release(0) }
