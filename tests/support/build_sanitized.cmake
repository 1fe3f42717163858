# Configures and builds a sanitized copy of the tree: cmake -DSOURCE= -DBINARY= -DSANITIZE= -DTARGETS= -P this
separate_arguments(TARGETS)
execute_process(COMMAND ${CMAKE_COMMAND} -G Ninja -S ${SOURCE} -B ${BINARY} -DCMAKE_BUILD_TYPE=RelWithDebInfo
                -DFATHOM_SANITIZE=${SANITIZE} COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND ${CMAKE_COMMAND} --build ${BINARY} --target ${TARGETS} COMMAND_ERROR_IS_FATAL ANY)
