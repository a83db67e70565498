"""Pictures of products for people: contact sheets, boxes drawn into views, maps with flights. Knows products."""
