# SPDX-License-Identifier: Apache-2.0
# The layers: a folder includes only lower ones (ARCHITECTURE.md). Checks every #include of engine/, devices/, apps/ and shaders/,
# the link lines of the libraries, the length of every source file, the width of comments,
# and that only third_party/ looks for packages. A file is a case.
#   cmake -DSOURCE=repository root -P layers_test.cmake
cmake_minimum_required(VERSION 3.25)

# FOLDER:LAYER. A folder includes only those of lower layers.
set(layers
    shaders/shared:0 engine/types:0 engine/include:0
    shaders/lib:1 engine/gpu:1 engine/scene:1 engine/model:1
    shaders:2 engine/reader:2 engine/contact:2 devices:2
    engine/haptics:3 engine/cloud:3
    engine/cycle:4
    engine/run:5 engine/reference:5
    engine/front:6 apps/binding:6 apps/verify:6
    apps/output:7
    apps:8
    apps/operate:9 apps/stability:9 apps/profile:9
    apps/tune:10
    apps/main.cpp:11)
foreach(entry ${layers})
    string(REGEX MATCH "^(.+):([0-9]+)$" ignored ${entry})
    set(layer_${CMAKE_MATCH_1} ${CMAKE_MATCH_2})
    list(APPEND folders ${CMAKE_MATCH_1})
endforeach()

# Every other folder must do without the GPU.
set(with_vulkan engine/gpu engine/cloud engine/cycle engine/run engine/front apps/binding apps/verify apps/output apps
    apps/operate apps/stability apps/profile apps/tune apps/main.cpp)
set(most_lines 300)
set(sources h cpp comp vert frag glsl cmake)
set(passed 0)
set(failed 0)

# The longest folder of the table that contains `path`; empty when there is none.
function(folder_of path result)
    set(best "")
    foreach(folder ${folders})
        string(LENGTH "${folder}" length)
        string(LENGTH "${best}" longest)
        string(FIND "${path}/" "${folder}/" at)
        if(at EQUAL 0 AND length GREATER longest)
            set(best ${folder})
        endif()
    endforeach()
    set(${result} "${best}" PARENT_SCOPE)
endfunction()

# Why a file of folder `from` must not include `path`; empty when it may.
function(why_not_include from path result)
    set(${result} "" PARENT_SCOPE)
    if(path MATCHES "^shaders/([a-z_]+)[.]h$")
        set(name ${CMAKE_MATCH_1})
        string(REGEX REPLACE "_(vert|frag)$" ".\\1" stage ${name})
        if(NOT EXISTS ${SOURCE}/shaders/${name}.comp AND NOT EXISTS ${SOURCE}/shaders/${stage})
            set(${result} "no shader makes it" PARENT_SCOPE)
        elseif(NOT from IN_LIST with_vulkan)
            set(${result} "${from} does without Vulkan" PARENT_SCOPE)
        endif()
        return()
    endif()
    if(NOT EXISTS ${SOURCE}/${path})
        set(${result} "it is not a path from the root of the repository" PARENT_SCOPE)
        return()
    endif()
    folder_of(${path} to)
    if(to STREQUAL "")
        set(${result} "its folder has no layer" PARENT_SCOPE)
    elseif(NOT to STREQUAL from AND NOT layer_${to} LESS layer_${from})
        set(${result} "${to} (layer ${layer_${to}}) is not below ${from} (layer ${layer_${from}})" PARENT_SCOPE)
    elseif(to STREQUAL "devices" AND from MATCHES "^engine/")
        set(${result} "the engine never calls a device" PARENT_SCOPE)
    elseif(to MATCHES "^engine/(gpu|cloud|cycle)$" AND NOT from IN_LIST with_vulkan)
        set(${result} "${from} does without Vulkan" PARENT_SCOPE)
    endif()
endfunction()

function(includes_faults file from result)
    set(faults "")
    file(STRINGS ${SOURCE}/${file} lines REGEX "^[ \t]*#[ \t]*include")
    foreach(line ${lines})
        if(line MATCHES "include[ \t]*\"([^\"]+)\"")
            why_not_include(${from} ${CMAKE_MATCH_1} why)
            if(NOT why STREQUAL "")
                list(APPEND faults "includes \"${CMAKE_MATCH_1}\": ${why}")
            endif()
        elseif(line MATCHES "include[ \t]*<(vulkan|vk_video)/" AND NOT from IN_LIST with_vulkan)
            list(APPEND faults "includes Vulkan: ${from} does without")
        elseif(line MATCHES "include[ \t]*<(engine|devices|apps|shaders|tests)/")
            list(APPEND faults "includes a file of ours in <>: no layer sees it")
        endif()
    endforeach()
    set(${result} "${faults}" PARENT_SCOPE)
endfunction()

# fathom_library(FOLDER LINKS a b): what it links must be below it, too.
function(links_faults file result)
    set(faults "")
    file(STRINGS ${SOURCE}/${file} lines REGEX "^[ \t]*fathom_library\\(")
    foreach(line ${lines})
        string(REGEX MATCH "fathom_library\\(([a-z/_]+)" ignored "${line}")
        set(from ${CMAKE_MATCH_1})
        string(REGEX REPLACE "^.*LINKS" "" line "${line}")
        string(REGEX MATCHALL "(engine_[a-z]+|devices|apps_[a-z]+|apps)( |\\))" links "${line}")
        foreach(link ${links})
            string(REGEX REPLACE "[ )]" "" to "${link}")
            string(REGEX REPLACE "^(engine|apps)_" "\\1/" to "${to}")
            if(NOT DEFINED layer_${to} OR NOT DEFINED layer_${from})
                list(APPEND faults "links ${to} to ${from}: no such layer")
            elseif(NOT layer_${to} LESS layer_${from})
                list(APPEND faults "links ${to} to ${from}, which is not above it")
            endif()
        endforeach()
    endforeach()
    set(${result} "${faults}" PARENT_SCOPE)
endfunction()

macro(count_case file faults)
    if("${faults}" STREQUAL "")
        math(EXPR passed "${passed} + 1")
    else()
        math(EXPR failed "${failed} + 1")
        foreach(fault ${faults})
            message("ERROR: ${file} ${fault}")
        endforeach()
    endif()
endmacro()

set(wanted "")
foreach(folder engine devices apps shaders tests third_party)
    foreach(kind ${sources})
        list(APPEND wanted ${SOURCE}/${folder}/*.${kind})
    endforeach()
    list(APPEND wanted ${SOURCE}/${folder}/CMakeLists.txt)
endforeach()
file(GLOB_RECURSE files RELATIVE ${SOURCE} ${wanted})
list(APPEND files CMakeLists.txt)
foreach(file ${files})
    set(faults "")
    file(READ ${SOURCE}/${file} text)
    string(REGEX MATCHALL "\n" ends "${text}")
    list(LENGTH ends lines)
    if(lines GREATER most_lines)
        list(APPEND faults "has ${lines} lines, more than ${most_lines}")
    endif()
    file(STRINGS ${SOURCE}/${file} wide LENGTH_MINIMUM 111 REGEX "^ *//") # clang-format does not wrap comments
    if(NOT "${wide}" STREQUAL "" AND NOT file MATCHES "[.]cmake$|CMakeLists")
        list(APPEND faults "has a comment wider than 110 columns: ${wide}")
    endif()
    if(file MATCHES "^(engine|devices|apps|shaders)/.*[.](h|cpp|comp|vert|frag|glsl)$")
        folder_of(${file} from)
        if(from STREQUAL "")
            list(APPEND faults "is in a folder without a layer")
        else()
            includes_faults(${file} ${from} more)
            list(APPEND faults ${more})
        endif()
    elseif(file MATCHES "(CMakeLists[.]txt|[.]cmake)$" AND NOT file MATCHES "^third_party/" AND NOT file MATCHES "layers_test|^tests/install/") # the latter is a separate project
        links_faults(${file} more)
        list(APPEND faults ${more})
        if(text MATCHES "(find_package|pkg_check_modules|pkg_search_module|find_library|find_path|FetchContent|ExternalProject)[A-Za-z_]*[ \t]*\\(")
            list(APPEND faults "looks for a package (${CMAKE_MATCH_1}): only third_party/ does")
        endif()
    endif()
    count_case(${file} "${faults}")
endforeach()

message("layers: ${passed} passed, ${failed} failed")
if(failed GREATER 0 OR passed EQUAL 0)
    message(FATAL_ERROR "a folder includes only lower ones")
endif()
