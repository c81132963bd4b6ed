"""Games on a server. client.py can be copied alone."""
