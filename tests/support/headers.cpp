// Carries the headers that the tests' programs share; they are compiled with it, once (tests/CMakeLists.txt).
