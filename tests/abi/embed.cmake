# The embeddable half by itself: configured without the baker it looks for none of the baker's
# packages, installs, and a host in C finds it by find_package and by pkg-config.
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
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${BINARY}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Release
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
