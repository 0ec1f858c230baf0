# SPDX-License-Identifier: Apache-2.0
# Compiler settings, and burin_library(): one CMake target a folder, linked one way.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# What ccache must be told before it caches anything that uses a precompiled header.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(ccache ${CMAKE_COMMAND} -E env CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE_PROGRAM})
  set(CMAKE_C_COMPILER_LAUNCHER ${ccache})
  set(CMAKE_CXX_COMPILER_LAUNCHER ${ccache})
endif()

# -ffp-contract=off: the same bits on machines with and without fused multiply-add (determinism is promised).
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor>
                    -Wno-missing-field-initializers -Werror -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # False alarms of GCC 12 on std::string operator+ and on optional/variant in optimised builds (PR 105651, 105562).
  add_compile_options(-Wno-restrict -Wno-maybe-uninitialized)
  if(BURIN_PCH)
    # The same kind of alarm: out of a precompiled header it is no longer known to come from a system header.
    add_compile_options(-Wno-stringop-overflow -Wno-stringop-overread -Wno-array-bounds)
  endif()
elseif(BURIN_PCH)
  # Without the time in it a precompiled header made twice is the same file, which ccache needs.
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:SHELL:-Xclang$<SEMICOLON>-fno-pch-timestamp>)
endif()
if(BURIN_SANITIZE)
  add_compile_options(-fsanitize=${BURIN_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${BURIN_SANITIZE})
endif()
if(BURIN_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()

if(BURIN_TESTS)
  enable_testing()
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()

# For code whose own speed nobody waits for: tests and the command line.
function(burin_optimise_little NAME)
  target_compile_options(${NAME} PRIVATE $<$<CONFIG:Release,RelWithDebInfo>:-O1>)
endfunction()

# Precompiled headers: parsing the standard library is a third to a half of what a file costs. Three of them, each shared by all
# targets of its kind: library code, tests (with GoogleTest) and the program (with CLI11 and JSON). They hold only what does not
# belong to this project; every file still includes what it uses (BURIN_PCH=OFF and scripts/tidy build without them).
set(BURIN_PCH_STD algorithm array cmath cstddef cstdint cstdlib cstring functional limits map memory numeric optional set span
    string string_view tuple utility variant vector)
set(BURIN_PCH_STREAMS chrono filesystem fstream random sstream)
function(burin_precompile NAME)
  list(TRANSFORM ARGN REPLACE "(.+)" "<\\1>")
  target_precompile_headers(${NAME} PRIVATE ${ARGN})
endfunction()
# burin_reuse_precompiled(NAME OWNER sources...): C sources go without.
function(burin_reuse_precompiled NAME OWNER)
  list(FILTER ARGN INCLUDE REGEX "\\.c$")
  if(ARGN)
    set_source_files_properties(${ARGN} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  endif()
  target_precompile_headers(${NAME} REUSE_FROM ${OWNER})
endfunction()
# The owners are a library and programs as their users are: position independence is part of what must agree.
if(BURIN_PCH)
  add_library(burin_pch OBJECT ${CMAKE_SOURCE_DIR}/cmake/pch.cpp)
  burin_precompile(burin_pch ${BURIN_PCH_STD})
  if(BURIN_TESTS)
    add_executable(burin_test_pch ${CMAKE_SOURCE_DIR}/cmake/pch.cpp)
    target_link_libraries(burin_test_pch PRIVATE GTest::gtest)
    burin_optimise_little(burin_test_pch)
    burin_precompile(burin_test_pch gtest/gtest.h ${BURIN_PCH_STD} ${BURIN_PCH_STREAMS})
  endif()
endif()

# burin_library(NAME
#   SOURCES  a.cpp b.cpp            (none: an interface target of headers only)
#   DEPS     burin_base ...         burin targets that stand further left; they must exist already, so that a
#                                   cycle, or a link against the data flow, stops the configuration
#   PRIVATE  fmt::fmt ...           third-party libraries that stay out of the headers
#   TESTS    a_test.cpp ...         unit tests beside the source, one program a folder
#   TEST_LIBS ...                   what only the tests link
#   TESTS_FAST a_test.cpp ...)      those of the tests that compute much themselves (see burin_test)
function(burin_library NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS;PRIVATE;TESTS;TEST_LIBS;TESTS_FAST" ${ARGN})
  foreach(dep IN LISTS ARG_DEPS)
    if(NOT TARGET ${dep})
      message(FATAL_ERROR "${NAME} links ${dep}, which does not stand left of it in the data flow")
    endif()
  endforeach()
  if(ARG_SOURCES)
    add_library(${NAME} STATIC ${ARG_SOURCES})
    target_include_directories(${NAME} PUBLIC ${CMAKE_SOURCE_DIR}/src)
    target_link_libraries(${NAME} PUBLIC ${ARG_DEPS} PRIVATE ${ARG_PRIVATE})
    if(BURIN_PCH)
      burin_reuse_precompiled(${NAME} burin_pch ${ARG_SOURCES})
    endif()
  else()
    add_library(${NAME} INTERFACE)
    target_include_directories(${NAME} INTERFACE ${CMAKE_SOURCE_DIR}/src)
    target_link_libraries(${NAME} INTERFACE ${ARG_DEPS})
  endif()
  if(BURIN_TESTS AND ARG_TESTS)
    burin_test(${NAME}_test SOURCES ${ARG_TESTS} LIBS ${NAME} ${ARG_PRIVATE} ${ARG_TEST_LIBS}
               FAST ${ARG_TESTS_FAST})
  endif()
endfunction()

# burin_test(NAME SOURCES ... LIBS ... FAST ...): a GoogleTest program, its tests registered one by one. Tests are compiled with
# little optimisation, which halves the time that takes; the sources named after FAST, brute force over much data, as all else.
function(burin_test NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS;FAST" ${ARGN})
  add_executable(${NAME} ${ARG_SOURCES})
  target_link_libraries(${NAME} PRIVATE ${ARG_LIBS} GTest::gtest GTest::gtest_main)
  burin_optimise_little(${NAME})
  if(ARG_FAST)
    # Not from the precompiled header: GCC 12 breaks off when that was made with another optimisation.
    set_source_files_properties(${ARG_FAST} PROPERTIES COMPILE_OPTIONS "$<$<CONFIG:Release,RelWithDebInfo>:-O2>"
                                                       SKIP_PRECOMPILE_HEADERS ON)
  endif()
  if(BURIN_PCH)
    burin_reuse_precompiled(${NAME} burin_test_pch ${ARG_SOURCES})
  endif()
  target_compile_definitions(${NAME} PRIVATE BURIN_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  gtest_discover_tests(${NAME} DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 300)
endfunction()

# burin_embed(TARGET HEADER_NAME FUNCTION files...): data files of the repository become part of the program, as
# a function burin::embedded::FUNCTION() that returns {name, text} pairs sorted by name.
function(burin_embed TARGET FUNCTION)
  set(out ${CMAKE_CURRENT_BINARY_DIR}/embedded_${FUNCTION}.cpp)
  set(files "")
  foreach(file IN LISTS ARGN)
    list(APPEND files ${CMAKE_SOURCE_DIR}/${file})
  endforeach()
  add_custom_command(
    OUTPUT ${out}
    COMMAND ${CMAKE_COMMAND} -DOUT=${out} -DFUNCTION=${FUNCTION} "-DFILES=${files}" -P
            ${CMAKE_SOURCE_DIR}/cmake/Embed.cmake
    DEPENDS ${files} ${CMAKE_SOURCE_DIR}/cmake/Embed.cmake
    VERBATIM)
  target_sources(${TARGET} PRIVATE ${out})
endfunction()
