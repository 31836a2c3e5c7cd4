// This file is empty. Two targets use it: they precompile headers of the tests and of the benchmarks.
