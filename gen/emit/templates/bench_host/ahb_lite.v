    // The bus: an AHB-Lite manager. What it sets at a falling edge of the clock stands still at the rising one.
    localparam integer ACCESS_CYCLES_MAX = {{ access_cycles_max }};
    reg hsel, hwrite;
    reg [1:0] htrans;
    reg [12:0] haddr;
    reg [31:0] hwdata;
    wire [31:0] hrdata;
    wire hreadyout, hresp;

    task host_idle;
        begin
            hsel = 1'b0;
            htrans = 2'd0;
            hwrite = 1'b0;
            haddr = 13'd0;
            hwdata = 32'd0;
        end
    endtask

    task transfer(input write, input [31:0] address, input [31:0] value);
        integer k;
        begin
            @(negedge clk);
            hsel = 1'b1;
            htrans = 2'd2;
            hwrite = write;
            haddr = {address[10:0], 2'b00};
            @(negedge clk);
            // The data phase; beside it stands no other address.
            hsel = 1'b0;
            htrans = 2'd0;
            hwdata = value;
            for (k = 0; k < ACCESS_CYCLES_MAX && !hreadyout; k = k + 1)
                @(negedge clk);
            check("hreadyout", {47'd0, hreadyout}, 48'd1);
            check("hresp", {47'd0, hresp}, 48'd0);
            answer = hrdata;
            @(negedge clk);
            host_idle;
        end
    endtask

    // The address phase of a transfer beside the data phase of the one before.
    task phase(input sel, input [1:0] trans, input write, input [31:0] address, input [31:0] data_of_last);
        integer k;
        begin
            hsel = sel;
            htrans = trans;
            hwrite = write;
            haddr = {address[10:0], 2'b00};
            hwdata = data_of_last;
            for (k = 0; k < ACCESS_CYCLES_MAX && !hreadyout; k = k + 1)
                @(negedge clk);
            check("hreadyout, pipelined", {47'd0, hreadyout}, 48'd1);
            answer = hrdata;
            @(negedge clk);
        end
    endtask

    // Transfers whose phases overlap, IDLE and BUSY, other slaves' transfers; at the word that is free for the host.
    task bus_limits;
        begin
            transfer(1'b0, CARD_ID, 32'd0);
            words_in[0] = answer;
            @(negedge clk);
            phase(1'b1, 2'd2, 1'b1, CARD_CONFIG_HOLD, 32'd0);
            phase(1'b1, 2'd2, 1'b0, CARD_ID, 32'hA1B2C300);
            phase(1'b1, 2'd2, 1'b0, CARD_CONFIG_HOLD, 32'd0);
            check("word, pipelined", answer, words_in[0]);
            phase(1'b1, 2'd2, 1'b1, CARD_CONFIG_HOLD, 32'd0);
            check("word that was written, pipelined", answer, 32'hA1B2C300);
            phase(1'b1, 2'd3, 1'b1, CARD_CONFIG_TRIGGER_PERIOD, 32'h4D5E6F00);
            phase(1'b1, 2'd0, 1'b1, CARD_CONFIG_HOLD, 32'h00345678);
            // IDLE, BUSY and another slave's transfer ask for nothing, and do not wait.
            check("hreadyout after IDLE", {47'd0, hreadyout}, 48'd1);
            phase(1'b1, 2'd1, 1'b1, CARD_CONFIG_HOLD, 32'hFFFFFF00);
            check("hreadyout after BUSY", {47'd0, hreadyout}, 48'd1);
            phase(1'b0, 2'd2, 1'b1, CARD_CONFIG_HOLD, 32'hFFFFFF00);
            check("hreadyout after another slave's address", {47'd0, hreadyout}, 48'd1);
            phase(1'b0, 2'd0, 1'b0, CARD_CONFIG_HOLD, 32'hFFFFFF00);
            host_idle;
            transfer(1'b0, CARD_CONFIG_HOLD, 32'd0);
            check("word after transfers of nobody", answer, 32'h4D5E6F00);
            transfer(1'b0, CARD_CONFIG_TRIGGER_PERIOD, 32'd0);
            check("word of the second of two writes", answer, 32'h00345678);
            transfer(1'b1, CARD_CONFIG_HOLD, 32'd0);
        end
    endtask
