# cmake -DTABLE=code.txt -DSOURCES=TOP -DOUT=code_lines.cpp -P count_code.cmake: counts the lines of the table's files
# that
# are neither blank nor only comment, into a source of compare/ladder/code_lines.h.
function(count_lines FILE RESULT)
    file(READ ${FILE} text)
    string(PREPEND text "\n")
    string(REGEX REPLACE "\n[ \t]*//[^\n]*" "" text "${text}") # comment-only lines
    string(REGEX REPLACE "[ \t\r]+" "" text "${text}")
    string(REGEX REPLACE "\n+" "\n" text "${text}\n") # blank lines
    string(REGEX REPLACE "[^\n]" "" text "${text}")
    string(LENGTH "${text}" count)
    math(EXPR count "${count} - 1") # the newline inserted at the start
    set(${RESULT} ${count} PARENT_SCOPE)
endfunction()

set(rows "")
file(STRINGS ${TABLE} table REGEX "^[0-9]")
foreach(row ${table})
    separate_arguments(words UNIX_COMMAND "${row}")
    list(POP_FRONT words rung side)
    foreach(word ${words})
        set(files ${word})
        if(NOT word MATCHES "\\.(h|cpp)$")
            set(files ${word}.h ${word}.cpp)
        endif()
        foreach(file ${files})
            if(EXISTS ${SOURCES}/${file})
                count_lines(${SOURCES}/${file} lines)
                string(APPEND rows "    {${rung}, \"${side}\", \"${file}\", ${lines}},\n")
            elseif(file STREQUAL word OR NOT EXISTS ${SOURCES}/${word}.cpp)
                message(FATAL_ERROR "${TABLE}: no file ${file}")
            endif()
        endforeach()
    endforeach()
endforeach()
file(WRITE ${OUT} "// Made from compare/ladder/code.txt by count_code.cmake.
#include \"compare/ladder/code_lines.h\"

namespace duet::compare {

namespace {

constexpr CodeFile kFiles[] = {
${rows}};

} // namespace

std::span<const CodeFile> code_files() { return kFiles; }

} // namespace duet::compare
")
