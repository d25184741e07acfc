# Run by ctest: the C++ block of README.md is the program that the outside project builds and runs.
file(READ ${README} readme)
file(READ ${EXAMPLE} example)
string(REGEX REPLACE "^//[^\n]*\n" "" example "${example}")
string(FIND "${readme}" "```cpp\n${example}```" place)
if(place EQUAL -1)
  message(FATAL_ERROR "README.md holds no ```cpp block that equals ${EXAMPLE} without its first line")
endif()
