# The embeddable half by itself: configured without the baker it looks for none of the baker's
# packages, installs, and a host in C finds it by find_package and by pkg-config.
# With OPALINE, the command line, a GL program adopts a baked asset: its picture is that of `opaline render`.
# Needs SOURCE, BINARY (a scratch folder), GENERATOR.
function(run)
    execute_process(COMMAND ${ARGV} RESULT_VARIABLE result OUTPUT_VARIABLE out ERROR_VARIABLE out)
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "${ARGV}\n${out}")
    endif()
endfunction()

file(REMOVE_RECURSE ${BINARY})
set(bake_packages embree OpenMesh OpenEXR Imath TinyGLTF glm TBB PNG JPEG CLI11 fmt nlohmann_json)
list(TRANSFORM bake_packages REPLACE "(.+)" "-DCMAKE_DISABLE_FIND_PACKAGE_\\1=ON")
# Not optimised, ten sources at a time where they allow it: half of the time, and nothing here depends on speed.
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${BINARY}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Debug
    -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=10
    -DOPALINE_BUILD_BAKE=OFF -DOPALINE_BUILD_TESTS=OFF ${bake_packages}
    -DCMAKE_INSTALL_PREFIX=${BINARY}/prefix ${LAUNCHER})
run(${CMAKE_COMMAND} --build ${BINARY}/build -j 2)
run(${CMAKE_COMMAND} --install ${BINARY}/build)
run(${CMAKE_COMMAND} -S ${SOURCE}/examples/minimal -B ${BINARY}/host -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${BINARY}/prefix)
run(${CMAKE_COMMAND} --build ${BINARY}/host)

file(GLOB_RECURSE pc ${BINARY}/prefix/*/opaline.pc)
get_filename_component(pc_folder ${pc} DIRECTORY)
set(ENV{PKG_CONFIG_PATH} ${pc_folder})
execute_process(COMMAND pkg-config --cflags --libs opaline OUTPUT_VARIABLE flags
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${flags}")
run(cc -std=c11 ${SOURCE}/examples/minimal/minimal.c ${flags} -o ${BINARY}/minimal_pc)

foreach(program host/minimal minimal_pc)
    execute_process(COMMAND ${CMAKE_COMMAND} -E env LD_LIBRARY_PATH=${pc_folder}/..
                            ${BINARY}/${program} ${SOURCE}/LICENSE
                    RESULT_VARIABLE result ERROR_VARIABLE message)
    if(NOT result EQUAL 3 OR NOT message MATCHES "LICENSE: .+")
        message(FATAL_ERROR "${program} on a file that is no asset: ${result} ${message}")
    endif()
endforeach()

# A host like a game, in C++11, which relights an asset frame by frame on two threads.
set(game ${SOURCE}/tests/abi/game)
run(${CMAKE_COMMAND} -S ${game} -B ${BINARY}/game -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${BINARY}/prefix)
run(${CMAKE_COMMAND} --build ${BINARY}/game)
execute_process(COMMAND pkg-config --cflags --libs opaline OUTPUT_VARIABLE flags
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${flags}")
run(c++ -std=c++11 -Wall -Wextra -pedantic -Werror -pthread ${game}/game.cpp ${flags} -o ${BINARY}/game_pc)
foreach(program game/game game_pc)
    run(${CMAKE_COMMAND} -E env LD_LIBRARY_PATH=${pc_folder}/..
        ${BINARY}/${program} ${SOURCE}/tests/data/golden/prim1-tran2.opal)
endforeach()

# examples/embed-gl, built by CMake from the installed tree, and by pkg-config.
set(example ${SOURCE}/examples/embed-gl)
run(${CMAKE_COMMAND} -S ${example} -B ${BINARY}/embed-gl -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${BINARY}/prefix)
run(${CMAKE_COMMAND} --build ${BINARY}/embed-gl)
execute_process(COMMAND pkg-config --cflags --libs opaline-gl OUTPUT_VARIABLE flags
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND pkg-config --variable=glsldir opaline-gl OUTPUT_VARIABLE glsl
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${flags}")
run(cc -std=gnu11 ${example}/embedded.c -DOPALINE_GLSL_DIR="${glsl}" ${flags} -lOpenGL -lEGL -lm -o ${BINARY}/embedded_pc)
execute_process(COMMAND diff ${example}/plain.c ${example}/embedded.c OUTPUT_VARIABLE difference)
string(REGEX MATCHALL "(^|\n)>" added "${difference}")
list(LENGTH added lines)
if(lines EQUAL 0 OR lines GREATER 29)
    message(FATAL_ERROR "adopting an asset adds ${lines} lines, not under 30")
endif()

execute_process(COMMAND ${BINARY}/embed-gl/plain ${BINARY}/plain.hdr RESULT_VARIABLE result ERROR_VARIABLE message)
if(message MATCHES "no OpenGL 4.3")
    message("NO OPENGL ON THIS MACHINE: the example is built, NOT run")
    return()
elseif(NOT result EQUAL 0)
    message(FATAL_ERROR "plain: ${result} ${message}")
endif()
if(NOT OPALINE)
    return()
endif()
run(${BINARY}/embed-gl/write_body ${BINARY})
run(${OPALINE} bake ${BINARY}/body.gltf --media ${example}/jade.json --quality draft -o ${BINARY}/body.opal)
run(${OPALINE} render ${BINARY}/body.opal --light sun:120.963757,21.100196 --eye 0.03,0.04,0.08 --target 0,0,0
    --fov 40 --size 320x240 --terms multiple,single --backend cpu -o ${BINARY}/rendered.exr)
foreach(program embed-gl/embedded embedded_pc)
    run(${CMAKE_COMMAND} -E env LD_LIBRARY_PATH=${pc_folder}/.. ${BINARY}/${program}
        ${BINARY}/embedded.hdr ${BINARY}/body.opal)
    # Pixels of eight bits beside floats, and silhouettes whose samples fall elsewhere.
    run(${OPALINE} compare ${BINARY}/embedded.hdr ${BINARY}/rendered.exr --max-rel 0.02)
endforeach()
execute_process(COMMAND ${OPALINE} compare ${BINARY}/plain.hdr ${BINARY}/rendered.exr --max-rel 0.02
                RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET)
if(NOT result EQUAL 1)
    message(FATAL_ERROR "the program without the asset shows the same picture")
endif()
