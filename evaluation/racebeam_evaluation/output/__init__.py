"""What is written: tables, figures, reports, and the folder of a run."""
