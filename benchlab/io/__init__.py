"""Everything that touches the disk: recordings, tables, result files."""
