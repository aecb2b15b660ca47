# cmake -DTABLE=code.txt -DSOURCES=TOP -DOUT=code_lines.cpp -P count_code.cmake: finds the files of each rung of the
# ladder by their includes, as code.txt tells, and writes their numbers of lines that are neither blank nor only
# comment to a source of compare/ladder/code_lines.h.
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

# Returns the files that a file brings along: what it includes, and the header or source of the same name.
function(neighbors FILE RESULT)
    file(STRINGS ${SOURCES}/${FILE} lines REGEX "^#include \"")
    list(TRANSFORM lines REPLACE "^#include \"([^\"]+)\".*" "\\1")
    string(REGEX REPLACE "\\.(h|cpp)$" "" stem ${FILE})
    set(result "")
    foreach(other ${lines} ${stem}.h ${stem}.cpp)
        if(EXISTS ${SOURCES}/${other} AND NOT other STREQUAL FILE)
            list(APPEND result ${other})
        endif()
    endforeach()
    set(${RESULT} "${result}" PARENT_SCOPE)
endfunction()

# Read the table: the rung of each listed file, by side, and each rung's list.
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
                foreach(its raster raytrace)
                    if(side STREQUAL its OR side STREQUAL both)
                        set(listed_${its}_${file} ${rung})
                        list(APPEND start_${its}_${rung} ${file})
                    endif()
                endforeach()
            elseif(file STREQUAL word OR NOT EXISTS ${SOURCES}/${word}.cpp)
                message(FATAL_ERROR "${TABLE}: no file ${file}")
            endif()
        endforeach()
    endforeach()
endforeach()

# Follow the includes from each rung's list, the lowest rung first.
set(reached "")
foreach(side raster raytrace)
    foreach(rung RANGE 7)
        set(queue ${start_${side}_${rung}})
        while(queue)
            list(POP_BACK queue file)
            if(DEFINED rung_${side}_${file} OR
               (DEFINED listed_${side}_${file} AND NOT listed_${side}_${file} EQUAL rung))
                continue()
            endif()
            set(rung_${side}_${file} ${rung})
            list(APPEND reached ${file})
            neighbors(${file} more)
            list(APPEND queue ${more})
        endwhile()
    endforeach()
endforeach()

set(rows "")
list(SORT reached)
list(REMOVE_DUPLICATES reached)
foreach(file ${reached})
    set(side both)
    if(NOT DEFINED rung_raster_${file})
        set(side raytrace)
        set(rung ${rung_raytrace_${file}})
    elseif(NOT DEFINED rung_raytrace_${file})
        set(side raster)
        set(rung ${rung_raster_${file}})
    elseif(rung_raster_${file} LESS rung_raytrace_${file})
        set(rung ${rung_raster_${file}})
    else()
        set(rung ${rung_raytrace_${file}})
    endif()
    count_lines(${SOURCES}/${file} lines)
    string(APPEND rows "    {${rung}, \"${side}\", \"${file}\", ${lines}},\n")
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
