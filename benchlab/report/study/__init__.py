"""The repeatability report: what stands in it, in which words, tables and pictures."""
