"""Languages of the page and its summary: data alone, so that the command line can be read without the library."""
NAMES = ("en", "zh")
