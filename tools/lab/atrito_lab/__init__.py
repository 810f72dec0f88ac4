"""The laboratory: sheets for a class, a deck for each student, marking. docs/labs/README.md tells how it is used."""
