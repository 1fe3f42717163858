# Doxygen's INPUT_FILTER: gives it the comments of a header, which are plain //, as documentation, in lines of the same numbers.
# The head of a file speaks of the file, and of the type that has the file's name (with Pass or not) and no comment of its own. A
# comment above declarations speaks of those right below it, up to the next comment or empty line; behind a declaration or a type's
# brace, of that. A comment with nothing below it speaks of no declaration and stays what it is.
function isComment(text) { return text ~ /^[ \t]*\/\// }
function plain(text) { sub(/^[ \t]*\/\/+ ?/, "", text); return escaped(text) }
function escaped(text) { gsub(/</, "\\<", text); return text } # no tag of HTML
# The name of this file as a type has it.
function typeName(    parts, n, i, name) {
    n = split(FILENAME, parts, "/")
    name = parts[n]
    sub(/[.]h$/, "", name)
    n = split(name, parts, "_")
    name = ""
    for (i = 1; i <= n; i++) name = name toupper(substr(parts[i], 1, 1)) substr(parts[i], 2)
    return name
}
# Gives out the comment that was held, as documentation or as it was.
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
    if (RSTART == trailing) { print substr($0, 1, RSTART - 1) "///< " plain($0); next } # goes on with the comment behind the line above
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
