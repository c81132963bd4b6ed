"""The board: a static page that compares submissions, each of which is a folder of an agent's results and logs."""
