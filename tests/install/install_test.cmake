# SPDX-License-Identifier: Apache-2.0
# Installs the built tree into an empty folder and builds the example hello.cpp outside of the sources, once by find_package and once
# by pkg-config; both must feel 10 N within 0.1 %. Compiles the README's program, the examples and designated initialisers with the
# warnings that a client may ask for. Checks which files are installed, that none of them names the build folder, and that the library
# exports the public API only.
#   cmake -DSOURCE= -DBINARY= -DCXX= -DVERSION= -P install_test.cmake
#   cmake -DSOURCE= -DPREFIX=/usr -DCXX= -DVERSION= -P install_test.cmake    tests the installation there
cmake_minimum_required(VERSION 3.25)
set(passed 0)
set(failed 0)

macro(check what)
    if(${ARGN})
        math(EXPR passed "${passed} + 1")
    else()
        math(EXPR failed "${failed} + 1")
        message("ERROR: ${what}")
    endif()
endmacro()

execute_process(COMMAND mktemp -d OUTPUT_VARIABLE stage OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
if(DEFINED PREFIX)
    set(root ${PREFIX})
    set(ours bin/fathom libexec/fathom/* share/fathom/* share/doc/fathom/* share/man/*/fathom* share/bash-completion/completions/fathom lib/udev/rules.d/70-fathom.rules
        include/fathom/* lib/*/libfathom.so* lib/*/pkgconfig/fathom.pc lib/*/cmake/fathom/*)
else()
    set(root ${stage}/installed)
    set(ours *)
    execute_process(COMMAND ${CMAKE_COMMAND} --install ${BINARY} --prefix ${root} OUTPUT_QUIET RESULT_VARIABLE result)
    check("cmake --install ends with ${result}" result EQUAL 0)
endif()

# What is where.
list(TRANSFORM ours PREPEND ${root}/)
file(GLOB_RECURSE files RELATIVE ${root} ${ours})
foreach(wanted bin/fathom libexec/fathom/fathom-reader share/fathom/scenes/demo.yaml share/fathom/scenes/task1.csv share/fathom/scenes/arm41.urdf lib/udev/rules.d/70-fathom.rules
        share/fathom/limits.d/fathom-limits.conf share/bash-completion/completions/fathom share/man/man1/fathom.1.gz
        share/man/man5/fathom-scene.5.gz share/doc/fathom/copyright include/fathom/fathom.h include/fathom/engine.h
        include/fathom/device_socket.h)
    check("${wanted} is not installed" wanted IN_LIST files)
endforeach()
set(headers ${files})
list(FILTER headers INCLUDE REGEX "^include/")
list(LENGTH headers count)
check("${count} public headers: ${headers}" count LESS_EQUAL 12)
string(REGEX MATCH "^(0[.])?[0-9]+" soversion ${VERSION}) # before 1.0 each minor version has an interface of its own
file(GLOB_RECURSE library ${root}/libfathom.so.${soversion})
set(archives ${files})
list(FILTER archives INCLUDE REGEX "[.]a$")
check("static libraries are installed: ${archives}" NOT archives)
execute_process(COMMAND nm -DC --defined-only ${library} OUTPUT_VARIABLE symbols RESULT_VARIABLE result)
string(REGEX REPLACE "[^\n]*fathom::v0::[^\n]*\n" "" others "${symbols}")
check("libfathom.so exports what is not public: ${others}" result EQUAL 0 AND NOT others)
check("libfathom.so exports its insides" NOT symbols MATCHES "::Impl::")
execute_process(COMMAND nm -D --undefined-only ${library} OUTPUT_VARIABLE symbols)
check("libfathom.so changes the process: ${CMAKE_MATCH_1}" NOT symbols MATCHES
      " (mlockall|setenv|putenv|sigaction|signal|alarm|setrlimit|v?fork|execv?[pe]*|system|popen)@")
execute_process(COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C readelf -d ${library} OUTPUT_VARIABLE needed)
check("libfathom.so loads the parsers of meshes and URDFs: ${CMAKE_MATCH_1}" NOT needed MATCHES "(assimp|urdfdom|console_bridge)")
list(FILTER files INCLUDE REGEX "(cmake|pc|conf|rules|h|yaml)$")
string(REGEX REPLACE "([][+.*()^$?\\])" "\\\\\\1" sources "${SOURCE}/") # at the start of a path, because the sources may be in /fathom
foreach(file ${files})
    file(READ ${root}/${file} text)
    string(REGEX MATCH "(^|-[IL]|[^]A-Za-z0-9_./})-])${sources}" named "${text}")
    check("${file} names the folder that it was built from" NOT named)
endforeach()

# Optional libraries are loaded at run time.
execute_process(COMMAND ${CMAKE_COMMAND} -E env LC_ALL=C readelf -d ${root}/bin/fathom OUTPUT_VARIABLE needed RESULT_VARIABLE result)
check("the program does not start without Cyclone DDS" result EQUAL 0 AND NOT needed MATCHES "libddsc")

# The program, from there.
execute_process(COMMAND ${root}/bin/fathom --version OUTPUT_VARIABLE said OUTPUT_STRIP_TRAILING_WHITESPACE)
check("fathom --version says '${said}'" said STREQUAL "fathom ${VERSION}")

function(must_feel what program)
    execute_process(COMMAND ${program} OUTPUT_VARIABLE said ERROR_VARIABLE said RESULT_VARIABLE result)
    if(result EQUAL 0 AND said MATCHES "fathom ${VERSION} on .*: force (9[.]99|10[.]00)[0-9] N")
        set(felt TRUE)
    else()
        set(felt FALSE)
    endif()
    check("${what}: exit ${result}, said '${said}'" felt)
    set(passed ${passed} PARENT_SCOPE)
    set(failed ${failed} PARENT_SCOPE)
endfunction()

# By CMake.
file(COPY ${CMAKE_CURRENT_LIST_DIR}/../../apps/examples/hello.cpp DESTINATION ${stage}/consumer)
file(WRITE ${stage}/consumer/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)
project(consumer CXX)
find_package(fathom ${VERSION} CONFIG REQUIRED)
add_executable(consumer hello.cpp)
target_link_libraries(consumer PRIVATE fathom::fathom)
")
execute_process(COMMAND ${CMAKE_COMMAND} -G Ninja -S ${stage}/consumer -B ${stage}/consumer/build -DCMAKE_PREFIX_PATH=${root} -DCMAKE_CXX_COMPILER=${CXX}
                OUTPUT_VARIABLE log ERROR_VARIABLE log RESULT_VARIABLE result)
if(result EQUAL 0)
    execute_process(COMMAND ${CMAKE_COMMAND} --build ${stage}/consumer/build OUTPUT_VARIABLE log ERROR_VARIABLE log RESULT_VARIABLE result)
endif()
check("the consumer does not build by find_package: ${log}" result EQUAL 0)
must_feel("the consumer built by find_package" ${stage}/consumer/build/consumer)

# By pkg-config.
file(GLOB_RECURSE pc ${root}/fathom.pc)
get_filename_component(pc "${pc}" DIRECTORY)
execute_process(COMMAND ${CMAKE_COMMAND} -E env PKG_CONFIG_PATH=${pc} pkg-config --cflags --libs fathom OUTPUT_VARIABLE flags
                OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE result)
check("pkg-config ends with ${result}" result EQUAL 0)
separate_arguments(flags UNIX_COMMAND "${flags}")
execute_process(COMMAND ${CXX} -std=c++20 -O1 ${stage}/consumer/hello.cpp -o ${stage}/by_pkg_config ${flags} -Wl,-rpath,${pc}/.. -pthread OUTPUT_VARIABLE log ERROR_VARIABLE log
                RESULT_VARIABLE result)
check("the consumer does not build by pkg-config: ${log}" result EQUAL 0)
must_feel("the consumer built by pkg-config" ${stage}/by_pkg_config)

# The README's program, around a device that the text leaves to the reader. It runs as long as its device does, so it is not run.
file(READ ${SOURCE}/README.md readme)
string(FIND "${readme}" "#include <fathom/" begin)
string(SUBSTRING "${readme}" ${begin} -1 program)
string(FIND "${program}" "```" end)
string(SUBSTRING "${program}" 0 ${end} program)
string(REPLACE "int main() {" "struct MyDevice {
    fathom::Pose pose() const { return {}; }
    bool waitForTick() const { return false; }
    void write(const fathom::Wrench&) const {}
};

int main() {" program "${program}")
file(WRITE ${stage}/readme.cpp "${program}")
check("the README's program has no MyDevice" program MATCHES "MyDevice device;")
file(GLOB examples ${SOURCE}/apps/examples/*.cpp)
foreach(client ${stage}/readme.cpp ${examples} ${CMAKE_CURRENT_LIST_DIR}/designated.cpp)
    execute_process(COMMAND ${CXX} -std=c++20 -Wall -Wextra -Werror -fsyntax-only ${client} ${flags} OUTPUT_VARIABLE log ERROR_VARIABLE log
                    RESULT_VARIABLE result)
    check("${client} does not compile without warnings: ${log}" result EQUAL 0)
endforeach()

# By Python, where the module is built.
if(EXISTS "${BINARY}/python")
    get_filename_component(libraries "${library}" DIRECTORY)
    execute_process(COMMAND ${CMAKE_COMMAND} -E env LD_LIBRARY_PATH=${libraries} PYTHONPATH=${root}/lib/python3/dist-packages /usr/bin/python3 -c
                            "import fathom; print(fathom.__version__, fathom.__file__)" OUTPUT_VARIABLE said ERROR_VARIABLE said)
    check("import fathom says '${said}'" said MATCHES "^${VERSION} ${root}/")
    foreach(wanted __init__.py _fathom.pyi py.typed)
        check("${wanted} of the Python module is not installed" EXISTS ${root}/lib/python3/dist-packages/fathom/${wanted})
    endforeach()
endif()

# Manual page and completion know every subcommand and every long option that the program lists.
execute_process(COMMAND gzip -dc ${root}/share/man/man1/fathom.1.gz OUTPUT_VARIABLE manual)
string(REPLACE "\\-" "-" manual "${manual}")
function(words_of result)
    list(JOIN ARGN " " typed)
    execute_process(COMMAND bash -c "source ${root}/share/bash-completion/completions/fathom; COMP_WORDS=(${root}/bin/fathom ${typed}); \
COMP_CWORD=$((\${#COMP_WORDS[@]} - 1)); _fathom; echo \${COMPREPLY[@]}" OUTPUT_VARIABLE words OUTPUT_STRIP_TRAILING_WHITESPACE)
    separate_arguments(words)
    set(${result} "${words}" PARENT_SCOPE)
endfunction()
execute_process(COMMAND ${root}/bin/fathom --help OUTPUT_VARIABLE help)
string(REGEX REPLACE "^.*Subcommands:" "" help "${help}")
string(REGEX MATCHALL "\n  [a-z-]+" subcommands "${help}")
list(TRANSFORM subcommands STRIP)
string(REGEX MATCHALL "\n  [a-z-]+, [a-z-]+" others "${help}") # "guard, bridge": two names
list(TRANSFORM others REPLACE ".*, " "")
check("the help has no second name of a subcommand" others)
list(LENGTH subcommands count)
check("the program lists ${count} subcommands" count GREATER_EQUAL 10)
words_of(commands "''")
foreach(name ${others})
    check("the completion does not offer ${name}" name IN_LIST commands)
endforeach()
foreach(subcommand ${subcommands})
    check("the completion does not offer ${subcommand}" subcommand IN_LIST commands)
    string(FIND "${manual}" ".SS fathom ${subcommand}" at)
    check("fathom(1) does not describe ${subcommand}" at GREATER -1)
    string(REGEX REPLACE "^.*[.]SS fathom ${subcommand}(.*)$" "\\1" section "${manual}")
    string(REGEX REPLACE "[.]S[SH] .*$" "" section "${section}")
    execute_process(COMMAND ${root}/bin/fathom ${subcommand} --help OUTPUT_VARIABLE help)
    string(REGEX MATCHALL "\n  --[a-z0-9-]+" options "${help}")
    list(TRANSFORM options STRIP)
    words_of(offered ${subcommand} --)
    foreach(option ${options})
        check("the completion of ${subcommand} does not offer ${option}" option IN_LIST offered)
        string(FIND "${section}" "${option}" at)
        check("fathom(1) does not describe ${subcommand} ${option}" at GREATER -1)
    endforeach()
endforeach()

# The completion knows every device and live source that the help names.
execute_process(COMMAND ${root}/bin/fathom replay --help OUTPUT_VARIABLE help)
foreach(option_and_form "--hand-device;a live hand: ([a-z0-9, ]+)" "--source;a live camera as ([^;]+)")
    list(POP_FRONT option_and_form option form)
    string(REGEX MATCH "${form}" named "${help}")
    string(REGEX MATCHALL "[a-z][a-z0-9:=]+" named "${CMAKE_MATCH_1}")
    list(REMOVE_ITEM named or)
    list(LENGTH named count)
    check("the help of ${option} names ${count} words: ${named}" count GREATER_EQUAL 3)
    words_of(offered replay ${option} "''")
    foreach(word ${named})
        check("the completion of ${option} does not offer ${word}" word IN_LIST offered)
    endforeach()
endforeach()

file(REMOVE_RECURSE ${stage})
message("install: ${passed} passed, ${failed} failed")
if(failed GREATER 0)
    message(FATAL_ERROR "what is installed is not whole")
endif()
