// Nothing: the target of this file has the headers that tests precompile (see test/CMakeLists.txt).
